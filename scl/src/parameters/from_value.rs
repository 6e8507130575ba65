//! The Rust types of parameters.

use scl_plan::ParameterValue;
use std::time::Duration;

/// The Rust type of a parameter.
pub trait FromParameter: Sized {
    /// The value as this type; `None` if it is of another type.
    fn from_value(value: &ParameterValue) -> Option<Self>;
}

impl FromParameter for bool {
    fn from_value(value: &ParameterValue) -> Option<Self> {
        if let ParameterValue::Bool(value) = value { Some(*value) } else { None }
    }
}

macro_rules! integers {
    ($($integer:ty)+) => {$(
        impl FromParameter for $integer {
            fn from_value(value: &ParameterValue) -> Option<Self> {
                if let ParameterValue::Integer(value) = value { (*value).try_into().ok() } else { None }
            }
        }
    )+};
}

integers!(i8 i16 i32 i64 u8 u16 u32 u64);

impl FromParameter for f64 {
    fn from_value(value: &ParameterValue) -> Option<Self> {
        if let ParameterValue::Float(value) = value { Some(*value) } else { None }
    }
}

impl FromParameter for f32 {
    fn from_value(value: &ParameterValue) -> Option<Self> {
        f64::from_value(value).map(|value| value as f32)
    }
}

impl FromParameter for String {
    fn from_value(value: &ParameterValue) -> Option<Self> {
        if let ParameterValue::Text(value) = value { Some(value.clone()) } else { None }
    }
}

impl FromParameter for Duration {
    fn from_value(value: &ParameterValue) -> Option<Self> {
        if let ParameterValue::Duration(value) = value { Some(*value) } else { None }
    }
}

impl<T: FromParameter> FromParameter for Vec<T> {
    fn from_value(value: &ParameterValue) -> Option<Self> {
        if let ParameterValue::List(values) = value { values.iter().map(T::from_value).collect() } else { None }
    }
}

impl<T: FromParameter, const LENGTH: usize> FromParameter for [T; LENGTH] {
    fn from_value(value: &ParameterValue) -> Option<Self> {
        Vec::from_value(value)?.try_into().ok()
    }
}
