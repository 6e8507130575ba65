//! Vectors in scalar arithmetic with a fixed order of operations, so that a port to another language agrees up to
//! rounding.

use crate::arcade;
use std::ops::{Add, AddAssign, Mul, Neg, Sub, SubAssign};

/// Three components, along the axes that the context names.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Vec3 {
    pub x: f64,
    pub y: f64,
    pub z: f64,
}

impl Vec3 {
    pub const ZERO: Self = Self::new(0.0, 0.0, 0.0);

    pub const fn new(x: f64, y: f64, z: f64) -> Self {
        Self { x, y, z }
    }

    pub fn dot(self, other: Self) -> f64 {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    pub fn cross(self, other: Self) -> Self {
        Self::new(
            self.y * other.z - self.z * other.y,
            self.z * other.x - self.x * other.z,
            self.x * other.y - self.y * other.x,
        )
    }

    pub fn length(self) -> f64 {
        self.dot(self).sqrt()
    }

    /// The length of the horizontal part.
    pub fn horizontal(self) -> f64 {
        (self.x * self.x + self.y * self.y).sqrt()
    }

    pub fn is_finite(self) -> bool {
        self.x.is_finite() && self.y.is_finite() && self.z.is_finite()
    }
}

/// Limits a value to `-limit..=limit`.
pub fn limit(value: f64, limit: f64) -> f64 {
    if value > limit {
        limit
    } else if value < -limit {
        -limit
    } else {
        value
    }
}

/// Limits a value to `lowest..=highest`. Unlike `f64::clamp` it does not panic when parameters contradict each other.
pub fn clamp(value: f64, lowest: f64, highest: f64) -> f64 {
    if value < lowest {
        lowest
    } else if value > highest {
        highest
    } else {
        value
    }
}

/// The difference of two angles, from -pi to pi.
pub fn angle_between(from: f64, to: f64) -> f64 {
    let difference = to - from;
    difference.sin().atan2(difference.cos())
}

impl Add for Vec3 {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self::new(self.x + other.x, self.y + other.y, self.z + other.z)
    }
}

impl Sub for Vec3 {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self::new(self.x - other.x, self.y - other.y, self.z - other.z)
    }
}

impl Mul<f64> for Vec3 {
    type Output = Self;

    fn mul(self, factor: f64) -> Self {
        Self::new(self.x * factor, self.y * factor, self.z * factor)
    }
}

impl Neg for Vec3 {
    type Output = Self;

    fn neg(self) -> Self {
        Self::new(-self.x, -self.y, -self.z)
    }
}

impl AddAssign for Vec3 {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Vec3 {
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl From<Vec3> for arcade::Vector {
    fn from(vector: Vec3) -> Self {
        Self { x: vector.x, y: vector.y, z: vector.z }
    }
}

/// A vector that is absent from a message is zero, as absent numbers are.
impl From<Option<arcade::Vector>> for Vec3 {
    fn from(vector: Option<arcade::Vector>) -> Self {
        vector.map_or(Self::ZERO, |vector| Self::new(vector.x, vector.y, vector.z))
    }
}
