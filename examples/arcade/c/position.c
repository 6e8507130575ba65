/*
 * Estimation of position and velocity. Accelerations are integrated, which is exact for seconds; slow measurements
 * correct what drifts (Higgins, A Comparison of Complementary and Kalman Filtering, 1975). The vertical filter is of
 * third order with equal poles, so that it also learns the bias of the acceleration (ArduPilot's AP_InertialNav). A
 * measurement is compared with the estimate of the time at which it was taken, from a ring of past estimates (Larsen et
 * al., Incorporation of Time Delayed Measurements in a Discrete-time Kalman Filter, 1998).
 */
#include "position.h"

static const uint64_t FIX_TIMEOUT_US = 5000000; /* without a fix for this long, the position is no longer valid */
static const double LONGEST_STEP = 0.4;         /* s: after a gap one measurement must not count for many */
static const double MAX_BIAS = 1.0;             /* m/s^2: no working accelerometer has a larger error */

static void remember(position_estimator *self, uint64_t time_us, quaternion attitude) {
    double upright = quaternion_up(attitude).z;
    self->history[self->next] = (past_estimate){time_us, self->position, self->velocity, upright};
    self->next = (self->next + 1) % POSITION_HISTORY;
}

void position_predict(position_estimator *self, uint64_t time_us, vector force, quaternion attitude, double elapsed) {
    vector gravity = {0.0, 0.0, GRAVITY};
    vector acceleration = vector_subtract(vector_subtract(quaternion_rotate(attitude, force), gravity), self->bias);
    vector curved = vector_scale(acceleration, 0.5 * elapsed * elapsed);
    self->position = vector_add(self->position, vector_add(vector_scale(self->velocity, elapsed), curved));
    self->velocity = vector_add(self->velocity, vector_scale(acceleration, elapsed));
    remember(self, time_us, attitude);
}

void position_coast(position_estimator *self, uint64_t time_us, quaternion attitude, double elapsed) {
    self->position = vector_add(self->position, vector_scale(self->velocity, elapsed));
    remember(self, time_us, attitude);
}

/*
 * The newest estimate that is not newer than `time_us`. NULL if it is older than all of them, for example because it is
 * of the time before a restart.
 */
static const past_estimate *past_at(const position_estimator *self, uint64_t time_us) {
    for (size_t age = 1; age <= POSITION_HISTORY; age++) {
        const past_estimate *past = &self->history[(self->next + POSITION_HISTORY - age) % POSITION_HISTORY];
        if (past->time_us != 0 && past->time_us <= time_us) {
            return past;
        }
    }
    return NULL;
}

/* The seconds from the last measurement to this one, within what the filters bear. */
static double step(uint64_t last_us, uint64_t time_us) {
    if (last_us == 0 || time_us <= last_us) {
        return 0.0;
    }
    double elapsed = (double)(time_us - last_us) * 1e-6;
    return elapsed > LONGEST_STEP ? LONGEST_STEP : elapsed;
}

/*
 * The height above ground by either sensor. While the ultrasonic sensor is in range, the barometer is calibrated by it.
 */
static double measured_height(position_estimator *self, const height_reading *height, double upright, double elapsed,
                              const parameters *parameters) {
    if (!height->in_range || !isfinite(height->ultrasonic)) {
        return height->barometer - self->barometer_offset;
    }
    double measured = height->ultrasonic * upright; /* it measures along the body's z axis */
    double change = height->barometer - measured - self->barometer_offset;
    self->barometer_offset += change * limit(parameters->tuning.barometer_correction * elapsed, 1.0);
    return measured;
}

void position_correct_height(position_estimator *self, const height_reading *height, const parameters *parameters) {
    const past_estimate *past = past_at(self, height->time_us);
    if (past == NULL) {
        return;
    }
    double elapsed = step(self->height_us, height->time_us);
    self->height_us = height->time_us;
    double error = measured_height(self, height, past->upright, elapsed, parameters) - past->position.z;
    if (!isfinite(error)) {
        return;
    }
    double bandwidth = parameters->tuning.height_correction;
    self->position.z += error * (3.0 * bandwidth * elapsed);
    self->velocity.z += error * (3.0 * bandwidth * bandwidth * elapsed);
    self->bias.z = limit(self->bias.z - error * (bandwidth * bandwidth * bandwidth * elapsed), MAX_BIAS);
}

static void start_at(position_estimator *self, vector position, vector velocity) {
    self->position = (vector){position.x, position.y, self->position.z};
    self->velocity = (vector){velocity.x, velocity.y, self->velocity.z};
}

void position_correct_fix(position_estimator *self, const fix_reading *fix, const parameters *parameters) {
    /* Without home, it is no place that the vehicle knows. */
    if (!fix->valid || !limits_are_known(&parameters->limits)) {
        return;
    }
    geodetic_position degrees = {.latitude = fix->latitude, .longitude = fix->longitude};
    local_position metres = geodesy_to_local(parameters->limits.home, degrees);
    vector position = {metres.east, metres.north, 0.0};
    vector velocity = {fix->east_speed, fix->north_speed, 0.0};
    if (!vector_is_finite(position) || !vector_is_finite(velocity)) {
        return;
    }
    if (self->fix_us == 0) {
        start_at(self, position, velocity);
        self->fix_us = fix->time_us;
        return;
    }
    const past_estimate *past = past_at(self, fix->time_us);
    if (past == NULL) {
        return;
    }
    double elapsed = step(self->fix_us, fix->time_us);
    self->fix_us = fix->time_us;
    vector position_error = vector_subtract(position, past->position);
    vector velocity_error = vector_subtract(velocity, past->velocity);
    position_error.z = 0.0;
    velocity_error.z = 0.0;
    double position_share = limit(parameters->tuning.position_correction * elapsed, 1.0);
    double velocity_share = limit(parameters->tuning.velocity_correction * elapsed, 1.0);
    self->position = vector_add(self->position, vector_scale(position_error, position_share));
    self->velocity = vector_add(self->velocity, vector_scale(velocity_error, velocity_share));
    vector bias = vector_subtract(self->bias, vector_scale(velocity_error, parameters->tuning.bias_correction * elapsed));
    self->bias = (vector){limit(bias.x, MAX_BIAS), limit(bias.y, MAX_BIAS), bias.z};
}

bool position_is_valid(const position_estimator *self, uint64_t time_us) {
    return self->fix_us != 0 && time_us <= self->fix_us + FIX_TIMEOUT_US;
}
