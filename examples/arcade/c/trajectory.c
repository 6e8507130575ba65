/*
 * The moving set-point on the way to a target. The vehicle follows a point that starts, cruises and brakes as the
 * vehicle itself can, so the controllers stay in their linear range. Braking follows the square-root law of ArduPilot's
 * position controller, with a linear part near the target.
 */
#include "trajectory.h"

/* Braking uses this share of the acceleration, because the acceleration itself takes time to build up. */
static const double BRAKING = 0.5;
/* Near the target, speed is proportional to the distance, 1/s. */
static const double APPROACH = 0.9;
/*
 * How fast the velocity follows, 1/s, and the time in which the acceleration builds up, s: without steps in the
 * acceleration, the vehicle tilts smoothly.
 */
static const double RESPONSE = 2.5;
static const double BUILD_UP = 0.2;

/* The speed at a distance from which the vehicle can still stop at the target. */
static double speed_at(double distance, double cruise, double acceleration) {
    double braking = sqrt(2.0 * BRAKING * acceleration * distance);
    double near = APPROACH * distance;
    double slower = braking < near ? braking : near;
    return slower < cruise ? slower : cruise;
}

static vector wanted_velocity(const set_point *self, const leg *leg, double acceleration) {
    vector way = vector_subtract(leg->target, self->position);
    double distance = vector_horizontal(way);
    double speed = speed_at(distance, leg->speed, acceleration);
    double share = distance > 1e-6 ? speed / distance : 0.0;
    double climb = speed_at(fabs(way.z), leg->climb, acceleration);
    return (vector){way.x * share, way.y * share, way.z < 0.0 ? -climb : climb};
}

void trajectory_advance(set_point *self, const leg *leg, const parameters *parameters, double elapsed) {
    double most = parameters->tuning.limit_acceleration;
    vector wanted = vector_scale(vector_subtract(wanted_velocity(self, leg, most), self->velocity), RESPONSE);
    double horizontal = vector_horizontal(wanted);
    if (horizontal > most) {
        wanted.x *= most / horizontal;
        wanted.y *= most / horizontal;
    }
    wanted.z = limit(wanted.z, most);
    vector change = vector_scale(vector_subtract(wanted, self->acceleration), elapsed / BUILD_UP);
    self->acceleration = vector_add(self->acceleration, change);
    self->velocity = vector_add(self->velocity, vector_scale(self->acceleration, elapsed));
    self->position = vector_add(self->position, vector_scale(self->velocity, elapsed));

    double turn = angle_between(self->yaw, leg->yaw);
    self->yaw += limit(turn, radians(parameters->tuning.limit_yaw_rate) * elapsed);
}
