//! Rotations as unit quaternions (Diebel, Representing Attitude: Euler Angles, Unit Quaternions, and Rotation Vectors,
//! 2006).

use super::vector::Vec3;

/// A rotation from body axes to the world's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quaternion {
    pub w: f64,
    pub x: f64,
    pub y: f64,
    pub z: f64,
}

impl Default for Quaternion {
    fn default() -> Self {
        Self { w: 1.0, x: 0.0, y: 0.0, z: 0.0 }
    }
}

impl Quaternion {
    /// From roll, pitch and yaw in radians, applied in the order yaw, pitch, roll.
    pub fn from_angles(angles: Vec3) -> Self {
        let (sr, cr) = ((0.5 * angles.x).sin(), (0.5 * angles.x).cos());
        let (sp, cp) = ((0.5 * angles.y).sin(), (0.5 * angles.y).cos());
        let (sy, cy) = ((0.5 * angles.z).sin(), (0.5 * angles.z).cos());
        Self {
            w: cr * cp * cy + sr * sp * sy,
            x: sr * cp * cy - cr * sp * sy,
            y: cr * sp * cy + sr * cp * sy,
            z: cr * cp * sy - sr * sp * cy,
        }
    }

    /// Roll, pitch and yaw in radians.
    pub fn angles(self) -> Vec3 {
        let Self { w, x, y, z } = self;
        let sine = 2.0 * (w * y - z * x);
        // Rounding may push the sine beyond 1 when the pitch is vertical.
        let sine = sine.clamp(-1.0, 1.0);
        Vec3::new(
            (2.0 * (w * x + y * z)).atan2(1.0 - 2.0 * (x * x + y * y)),
            sine.atan2((1.0 - sine * sine).sqrt()),
            (2.0 * (w * z + x * y)).atan2(1.0 - 2.0 * (y * y + z * z)),
        )
    }

    /// A rotation by `vector`'s length in radians about its direction.
    pub fn from_rotation_vector(vector: Vec3) -> Self {
        let angle = vector.length();
        // sin(angle / 2) / angle, which is 0 / 0 without rotation.
        let factor = if angle < 1e-9 { 0.5 } else { (0.5 * angle).sin() / angle };
        Self { w: (0.5 * angle).cos(), x: vector.x * factor, y: vector.y * factor, z: vector.z * factor }
    }

    /// The shortest rotation vector: its length is the angle in radians.
    pub fn rotation_vector(self) -> Vec3 {
        let sign = if self.w < 0.0 { -1.0 } else { 1.0 };
        let axis = Vec3::new(self.x, self.y, self.z) * sign;
        let sine = axis.length();
        let angle = 2.0 * sine.atan2(sign * self.w);
        axis * if sine < 1e-9 { 2.0 } else { angle / sine }
    }

    /// This rotation after `other`.
    pub fn multiply(self, other: Self) -> Self {
        Self {
            w: self.w * other.w - self.x * other.x - self.y * other.y - self.z * other.z,
            x: self.w * other.x + self.x * other.w + self.y * other.z - self.z * other.y,
            y: self.w * other.y - self.x * other.z + self.y * other.w + self.z * other.x,
            z: self.w * other.z + self.x * other.y - self.y * other.x + self.z * other.w,
        }
    }

    /// The opposite rotation.
    pub fn conjugate(self) -> Self {
        Self { w: self.w, x: -self.x, y: -self.y, z: -self.z }
    }

    /// Removes the rounding errors that many products leave.
    pub fn normalized(self) -> Self {
        let length = (self.w * self.w + self.x * self.x + self.y * self.y + self.z * self.z).sqrt();
        Self { w: self.w / length, x: self.x / length, y: self.y / length, z: self.z / length }
    }

    /// Turns a vector from body axes to the world's.
    pub fn rotate(self, vector: Vec3) -> Vec3 {
        let axis = Vec3::new(self.x, self.y, self.z);
        let twice = axis.cross(vector) * 2.0;
        vector + twice * self.w + axis.cross(twice)
    }

    /// The body's z axis in the world.
    pub fn up(self) -> Vec3 {
        self.rotate(Vec3::new(0.0, 0.0, 1.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(a: Vec3, b: Vec3) -> bool {
        (a - b).length() < 1e-12
    }

    #[test]
    fn angles_survive_the_way_there_and_back() {
        let angles = Vec3::new(0.3, -0.7, 2.5);
        assert!(close(Quaternion::from_angles(angles).angles(), angles));
    }

    #[test]
    fn positive_pitch_lowers_the_nose_and_positive_roll_raises_the_left_side() {
        let pitched = Quaternion::from_angles(Vec3::new(0.0, 0.1, 0.0)).rotate(Vec3::new(1.0, 0.0, 0.0));
        assert!(pitched.z < 0.0);
        let rolled = Quaternion::from_angles(Vec3::new(0.1, 0.0, 0.0)).rotate(Vec3::new(0.0, 1.0, 0.0));
        assert!(rolled.z > 0.0);
    }

    #[test]
    fn a_rotation_vector_survives_the_way_there_and_back() {
        for vector in [Vec3::new(0.4, -1.2, 0.3), Vec3::new(1e-12, 0.0, 0.0), Vec3::ZERO] {
            assert!(close(Quaternion::from_rotation_vector(vector).rotation_vector(), vector));
        }
    }

    #[test]
    fn a_product_rotates_by_the_right_factor_first() {
        let turn = Quaternion::from_angles(Vec3::new(0.0, 0.0, 1.0));
        let tilt = Quaternion::from_angles(Vec3::new(0.2, 0.0, 0.0));
        let vector = Vec3::new(1.0, 2.0, 3.0);
        assert!(close(turn.multiply(tilt).rotate(vector), turn.rotate(tilt.rotate(vector))));
        assert!(close(turn.multiply(turn.conjugate()).rotate(vector), vector));
    }
}
