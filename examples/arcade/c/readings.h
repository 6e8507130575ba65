/* Messages as plain values, which stay when the messages are freed. */
#ifndef READINGS_H
#define READINGS_H

#include "geodesy.h"
#include "vector.h"

typedef struct inertial_reading {
    uint64_t time_us;
    vector acceleration, rates, angles;
} inertial_reading;

typedef struct height_reading {
    uint64_t time_us;
    bool in_range;
    double ultrasonic; /* m, if in range */
    double barometer;  /* m */
} height_reading;

typedef struct fix_reading {
    uint64_t time_us;
    bool valid;
    double latitude, longitude;     /* degrees */
    double east_speed, north_speed; /* m/s */
} fix_reading;

typedef struct limits {
    home home;
    double fence_radius, fence_height; /* m from home, and above it */
    double speed, climb;               /* m/s */
} limits;

typedef struct command {
    uint64_t effective_us;
    uint32_t id;
    Arcade__Action action;
    vector target;
    double yaw, speed;
} command;

static inline limits limits_from_message(const Arcade__Limits *message) {
    return (limits){
        .home = {message->home_latitude, message->home_longitude, message->home_altitude},
        .fence_radius = message->fence_radius,
        .fence_height = message->fence_height,
        .speed = message->speed,
        .climb = message->climb,
    };
}

static inline bool limits_are_known(const limits *self) {
    return self->fence_radius > 0.0;
}

static inline inertial_reading inertial_from_message(const Arcade__Inertial *message) {
    return (inertial_reading){
        .time_us = message->time_us,
        .acceleration = vector_from_message(message->acceleration),
        .rates = vector_from_message(message->rates),
        .angles = vector_from_message(message->angles),
    };
}

static inline height_reading height_from_message(const Arcade__Height *message) {
    bool in_range = message->range_case == ARCADE__HEIGHT__RANGE_ULTRASONIC;
    return (height_reading){
        .time_us = message->time_us,
        .in_range = in_range,
        .ultrasonic = in_range ? message->ultrasonic : 0.0,
        .barometer = message->barometer,
    };
}

static inline fix_reading fix_from_message(const Arcade__Fix *message) {
    return (fix_reading){
        .time_us = message->time_us,
        .valid = message->quality == ARCADE__FIX_QUALITY__FIX_QUALITY_2D ||
                 message->quality == ARCADE__FIX_QUALITY__FIX_QUALITY_3D,
        .latitude = message->latitude,
        .longitude = message->longitude,
        .east_speed = message->east_speed,
        .north_speed = message->north_speed,
    };
}

static inline command command_from_message(const Arcade__Command *message) {
    return (command){
        .effective_us = message->effective_us,
        .id = message->id,
        .action = message->action,
        .target = vector_from_message(message->target),
        .yaw = message->yaw,
        .speed = message->speed,
    };
}

#endif
