/*
 * Rotations as unit quaternions (Diebel, Representing Attitude: Euler Angles, Unit Quaternions, and Rotation Vectors,
 * 2006).
 */
#ifndef QUATERNION_H
#define QUATERNION_H

#include "vector.h"

/* A rotation from body axes to the world's. */
typedef struct quaternion {
    double w, x, y, z;
} quaternion;

static const quaternion QUATERNION_IDENTITY = {1.0, 0.0, 0.0, 0.0};

/* From and to roll, pitch and yaw in radians, applied in the order yaw, pitch, roll. */
quaternion quaternion_from_angles(vector angles);
vector quaternion_angles(quaternion q);

/* A rotation by the vector's length in radians about its direction, and back: of the two ways, the shorter. */
quaternion quaternion_from_rotation_vector(vector rotation);
vector quaternion_rotation_vector(quaternion q);

/* `first` after `second`. */
quaternion quaternion_multiply(quaternion first, quaternion second);
quaternion quaternion_conjugate(quaternion q);

/* Removes the rounding errors that many products leave. */
quaternion quaternion_normalize(quaternion q);

/* Turns a vector from body axes to the world's. */
vector quaternion_rotate(quaternion q, vector v);

/* The body's z axis in the world. */
vector quaternion_up(quaternion q);

#endif
