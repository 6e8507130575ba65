/* Vectors in scalar arithmetic of a fixed order, so that this program and its Rust twin agree to rounding. */
#ifndef VECTOR_H
#define VECTOR_H

#include "arcade.pb-c.h"

#include <math.h>
#include <stdbool.h>

/* Three components, along the axes that the context names. */
typedef struct vector {
    double x, y, z;
} vector;

static inline vector vector_add(vector a, vector b) {
    return (vector){a.x + b.x, a.y + b.y, a.z + b.z};
}

static inline vector vector_subtract(vector a, vector b) {
    return (vector){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline vector vector_scale(vector a, double factor) {
    return (vector){a.x * factor, a.y * factor, a.z * factor};
}

static inline double vector_dot(vector a, vector b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline vector vector_cross(vector a, vector b) {
    return (vector){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static inline double vector_length(vector a) {
    return sqrt(vector_dot(a, a));
}

/* The length of the horizontal part. */
static inline double vector_horizontal(vector a) {
    return sqrt(a.x * a.x + a.y * a.y);
}

static inline bool vector_is_finite(vector a) {
    return isfinite(a.x) && isfinite(a.y) && isfinite(a.z);
}

/* A vector that is absent from a message is zero, as absent numbers are. */
static inline vector vector_from_message(const Arcade__Vector *message) {
    return message == NULL ? (vector){0} : (vector){message->x, message->y, message->z};
}

static inline Arcade__Vector vector_to_message(vector a) {
    Arcade__Vector message = ARCADE__VECTOR__INIT;
    message.x = a.x;
    message.y = a.y;
    message.z = a.z;
    return message;
}

static inline double clamp(double value, double lowest, double highest) {
    return value < lowest ? lowest : value > highest ? highest : value;
}

/* Limits a value to -most to most. */
static inline double limit(double value, double most) {
    return value > most ? most : value < -most ? -most : value;
}

static inline double radians(double degrees) {
    return degrees * (3.14159265358979323846 / 180.0);
}

/* The difference of two angles, from -pi to pi. */
static inline double angle_between(double from, double to) {
    double difference = to - from;
    return atan2(sin(difference), cos(difference));
}

#endif
