/* Rotations as unit quaternions. */
#include "quaternion.h"

quaternion quaternion_from_angles(vector angles) {
    double sr = sin(0.5 * angles.x), cr = cos(0.5 * angles.x);
    double sp = sin(0.5 * angles.y), cp = cos(0.5 * angles.y);
    double sy = sin(0.5 * angles.z), cy = cos(0.5 * angles.z);
    return (quaternion){
        .w = cr * cp * cy + sr * sp * sy,
        .x = sr * cp * cy - cr * sp * sy,
        .y = cr * sp * cy + sr * cp * sy,
        .z = cr * cp * sy - sr * sp * cy,
    };
}

vector quaternion_angles(quaternion q) {
    /* Rounding may take the sine of a vertical pitch past 1. */
    double sine = clamp(2.0 * (q.w * q.y - q.z * q.x), -1.0, 1.0);
    return (vector){
        atan2(2.0 * (q.w * q.x + q.y * q.z), 1.0 - 2.0 * (q.x * q.x + q.y * q.y)),
        atan2(sine, sqrt(1.0 - sine * sine)),
        atan2(2.0 * (q.w * q.z + q.x * q.y), 1.0 - 2.0 * (q.y * q.y + q.z * q.z)),
    };
}

quaternion quaternion_from_rotation_vector(vector rotation) {
    double angle = vector_length(rotation);
    /* sin(angle / 2) / angle, which is 0 / 0 without rotation. */
    double factor = angle < 1e-9 ? 0.5 : sin(0.5 * angle) / angle;
    return (quaternion){cos(0.5 * angle), rotation.x * factor, rotation.y * factor, rotation.z * factor};
}

vector quaternion_rotation_vector(quaternion q) {
    double sign = q.w < 0.0 ? -1.0 : 1.0;
    vector axis = vector_scale((vector){q.x, q.y, q.z}, sign);
    double sine = vector_length(axis);
    double angle = 2.0 * atan2(sine, sign * q.w);
    return vector_scale(axis, sine < 1e-9 ? 2.0 : angle / sine);
}

quaternion quaternion_multiply(quaternion a, quaternion b) {
    return (quaternion){
        .w = a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z,
        .x = a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
        .y = a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
        .z = a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w,
    };
}

quaternion quaternion_conjugate(quaternion q) {
    return (quaternion){q.w, -q.x, -q.y, -q.z};
}

quaternion quaternion_normalize(quaternion q) {
    double length = sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    return (quaternion){q.w / length, q.x / length, q.y / length, q.z / length};
}

vector quaternion_rotate(quaternion q, vector v) {
    vector axis = {q.x, q.y, q.z};
    vector twice = vector_scale(vector_cross(axis, v), 2.0);
    return vector_add(vector_add(v, vector_scale(twice, q.w)), vector_cross(axis, twice));
}

vector quaternion_up(quaternion q) {
    return quaternion_rotate(q, (vector){0.0, 0.0, 1.0});
}
