//! The values of a parameter, as arrays that C programs can read.

use scl::plan::{ParameterPlan, ParameterType, ParameterValue, Scalar};
use std::ffi::{CString, c_char, c_void};
use std::slice;

/// All values of a parameter: one, or the items of a list. Their addresses stay while it exists.
pub(crate) enum Items {
    Bool(Vec<bool>),
    I8(Vec<i8>),
    I16(Vec<i16>),
    I32(Vec<i32>),
    I64(Vec<i64>),
    U8(Vec<u8>),
    U16(Vec<u16>),
    U32(Vec<u32>),
    U64(Vec<u64>),
    F32(Vec<f32>),
    F64(Vec<f64>),
    Text(Texts),
    /// In nanoseconds.
    Duration(Vec<u64>),
}

/// Texts, and their addresses for C.
pub(crate) struct Texts {
    addresses: Vec<*const c_char>,
    _texts: Vec<CString>,
}

// SAFETY: nobody changes the texts, and they exist as long as their addresses.
unsafe impl Send for Texts {}
// SAFETY: as above.
unsafe impl Sync for Texts {}

impl Items {
    pub(crate) fn of(plan: &ParameterPlan, value: &ParameterValue) -> Self {
        let values = match (&plan.kind, value) {
            (ParameterType::List(..), ParameterValue::List(values)) => values,
            _ => slice::from_ref(value),
        };
        match plan.kind.scalar() {
            Some(Scalar::Bool) => {
                Self::Bool(all(values, |it| if let ParameterValue::Bool(it) = it { Some(*it) } else { None }))
            }
            Some(Scalar::I8) => Self::I8(integers(values)),
            Some(Scalar::I16) => Self::I16(integers(values)),
            Some(Scalar::I32) => Self::I32(integers(values)),
            Some(Scalar::I64) => Self::I64(integers(values)),
            Some(Scalar::U8) => Self::U8(integers(values)),
            Some(Scalar::U16) => Self::U16(integers(values)),
            Some(Scalar::U32) => Self::U32(integers(values)),
            Some(Scalar::U64) => Self::U64(integers(values)),
            Some(Scalar::F32) => Self::F32(all(values, |it| float(it).map(|it| it as f32))),
            Some(Scalar::F64) => Self::F64(all(values, float)),
            Some(Scalar::Duration) => Self::Duration(all(values, nanoseconds)),
            Some(Scalar::Text) | None => Self::Text(Texts::of(values)),
        }
    }

    pub(crate) fn count(&self) -> usize {
        self.array().1
    }

    /// The address of the first value, not NULL even if there is none.
    pub(crate) fn address(&self) -> *const c_void {
        self.array().0
    }

    fn array(&self) -> (*const c_void, usize) {
        fn of<T>(items: &[T]) -> (*const c_void, usize) {
            (items.as_ptr().cast(), items.len())
        }
        match self {
            Self::Bool(items) => of(items),
            Self::I8(items) => of(items),
            Self::I16(items) => of(items),
            Self::I32(items) => of(items),
            Self::I64(items) => of(items),
            Self::U8(items) => of(items),
            Self::U16(items) => of(items),
            Self::U32(items) => of(items),
            Self::U64(items) | Self::Duration(items) => of(items),
            Self::F32(items) => of(items),
            Self::F64(items) => of(items),
            Self::Text(texts) => of(&texts.addresses),
        }
    }

    /// The type as in the topology file.
    pub(crate) fn type_word(&self) -> &'static str {
        let scalar = match self {
            Self::Bool(_) => Scalar::Bool,
            Self::I8(_) => Scalar::I8,
            Self::I16(_) => Scalar::I16,
            Self::I32(_) => Scalar::I32,
            Self::I64(_) => Scalar::I64,
            Self::U8(_) => Scalar::U8,
            Self::U16(_) => Scalar::U16,
            Self::U32(_) => Scalar::U32,
            Self::U64(_) => Scalar::U64,
            Self::F32(_) => Scalar::F32,
            Self::F64(_) => Scalar::F64,
            Self::Text(_) => Scalar::Text,
            Self::Duration(_) => Scalar::Duration,
        };
        scalar.word()
    }

    pub(crate) fn bool(&self, index: usize) -> Option<bool> {
        if let Self::Bool(items) = self { items.get(index).copied() } else { None }
    }

    pub(crate) fn integer(&self, index: usize) -> Option<i128> {
        fn at<T: Copy + Into<i128>>(items: &[T], index: usize) -> Option<i128> {
            items.get(index).map(|item| (*item).into())
        }
        match self {
            Self::I8(items) => at(items, index),
            Self::I16(items) => at(items, index),
            Self::I32(items) => at(items, index),
            Self::I64(items) => at(items, index),
            Self::U8(items) => at(items, index),
            Self::U16(items) => at(items, index),
            Self::U32(items) => at(items, index),
            Self::U64(items) => at(items, index),
            Self::Bool(_) | Self::F32(_) | Self::F64(_) | Self::Text(_) | Self::Duration(_) => None,
        }
    }

    pub(crate) fn float(&self, index: usize) -> Option<f64> {
        match self {
            Self::F32(items) => items.get(index).map(|item| f64::from(*item)),
            Self::F64(items) => items.get(index).copied(),
            _ => None,
        }
    }

    pub(crate) fn duration(&self, index: usize) -> Option<u64> {
        if let Self::Duration(items) = self { items.get(index).copied() } else { None }
    }

    pub(crate) fn text(&self, index: usize) -> Option<*const c_char> {
        if let Self::Text(texts) = self { texts.addresses.get(index).copied() } else { None }
    }
}

impl Texts {
    fn of(values: &[ParameterValue]) -> Self {
        let text = |value: &ParameterValue| if let ParameterValue::Text(it) = value { Some(it.clone()) } else { None };
        // No value of a parameter contains a NUL.
        let texts: Vec<CString> = all(values, |it| text(it).map(|it| CString::new(it).unwrap_or_default()));
        Self { addresses: texts.iter().map(|text| text.as_ptr()).collect(), _texts: texts }
    }
}

/// The values in one type, which all of them have.
fn all<T>(values: &[ParameterValue], of: impl Fn(&ParameterValue) -> Option<T>) -> Vec<T> {
    values.iter().filter_map(of).collect()
}

fn integers<T: TryFrom<i128>>(values: &[ParameterValue]) -> Vec<T> {
    all(values, |value| if let ParameterValue::Integer(it) = value { T::try_from(*it).ok() } else { None })
}

fn float(value: &ParameterValue) -> Option<f64> {
    if let ParameterValue::Float(value) = value { Some(*value) } else { None }
}

/// Durations of more than 584 years become the longest ones.
fn nanoseconds(value: &ParameterValue) -> Option<u64> {
    if let ParameterValue::Duration(it) = value { Some(it.as_nanos().try_into().unwrap_or(u64::MAX)) } else { None }
}
