/*
 * Attitude estimation: the passive filter on unit quaternions of Mahony, Hamel and Pflimlin, Nonlinear Complementary
 * Filters on the Special Orthogonal Group, 2008, section IV-C. Rates are exact for a short time but drift; the unit's
 * own angles do not drift but are noisy.
 */
#include "attitude.h"

static const double MAX_BIAS = 0.1; /* rad/s: no working gyroscope has more */

attitude_estimator attitude_new(void) {
    return (attitude_estimator){.attitude = QUATERNION_IDENTITY};
}

void attitude_reset(attitude_estimator *self, vector rates, vector angles) {
    self->rates = vector_subtract(rates, self->bias);
    self->attitude = quaternion_from_angles(angles);
}

void attitude_update(attitude_estimator *self, vector rates, vector angles, double elapsed,
                     const parameters *parameters) {
    self->rates = vector_subtract(rates, self->bias);
    quaternion turned = quaternion_from_rotation_vector(vector_scale(self->rates, elapsed));
    quaternion predicted = quaternion_multiply(self->attitude, turned);
    quaternion difference = quaternion_multiply(quaternion_conjugate(predicted), quaternion_from_angles(angles));
    vector error = quaternion_rotation_vector(difference);
    vector correction = vector_scale(error, parameters->tuning.attitude_correction * elapsed);
    self->attitude = quaternion_normalize(quaternion_multiply(predicted, quaternion_from_rotation_vector(correction)));
    vector bias = vector_subtract(self->bias, vector_scale(error, parameters->tuning.gyro_bias_correction * elapsed));
    self->bias = (vector){limit(bias.x, MAX_BIAS), limit(bias.y, MAX_BIAS), limit(bias.z, MAX_BIAS)};
}
