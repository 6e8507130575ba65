/*
 * Navigation: grounded -> taking off -> flying -> landing -> grounded. Commands and the land detector change the mode.
 */
#include "navigation.h"

static const double SPIN_UP = 1.0; /* s: the motors idle for this long before take-off */
static const double REACHED = 0.3; /* m: a take-off is complete this close to its height */
static const double FLARE = 3.0;   /* m: below this height the vehicle sinks slowly */
/* m: the set-point of a landing goes on below the ground, so that the thrust decreases after touching down */
static const double UNDERGROUND = -5.0;

static void enter(navigator *self, Arcade__Mode mode) {
    self->mode = mode;
    self->in_mode = 0.0;
    self->land_detector = (land_detector){0};
}

static set_point at_rest(const estimate *estimate) {
    return (set_point){.position = estimate->position, .yaw = estimate->yaw};
}

static void take_off(navigator *self, double height, const estimate *estimate) {
    enter(self, ARCADE__MODE__MODE_TAKING_OFF);
    self->set_point = at_rest(estimate);
    self->target = (vector){estimate->position.x, estimate->position.y, height};
    self->target_yaw = estimate->yaw;
}

static void go_to(navigator *self, const command *command) {
    enter(self, ARCADE__MODE__MODE_FLYING);
    self->target = command->target;
    self->target_yaw = command->yaw;
    if (command->speed > 0.0 && command->speed < self->speed) {
        self->speed = command->speed;
    }
}

/* Straight down from here; a movement ends where it can stop. */
static void land(navigator *self) {
    enter(self, ARCADE__MODE__MODE_LANDING);
    vector velocity = self->set_point.velocity;
    velocity.z = 0.0;
    /* Half a second at the present velocity is where braking takes it, nearly. */
    self->target = vector_add(self->set_point.position, vector_scale(velocity, 0.5));
    self->target.z = 0.0;
}

void navigation_begin(navigator *self, const command *command, const estimate *estimate, const parameters *parameters) {
    self->command_id = command->id;
    self->speed = parameters->limits.speed;
    switch (command->action) {
    case ARCADE__ACTION__ACTION_TAKE_OFF:
        take_off(self, command->target.z, estimate);
        break;
    case ARCADE__ACTION__ACTION_GO_TO:
        go_to(self, command);
        break;
    case ARCADE__ACTION__ACTION_LAND:
        land(self);
        break;
    default:
        break;
    }
}

static leg leg_of(const navigator *self, const parameters *parameters) {
    leg leg = {.target = self->target, .yaw = self->target_yaw, .speed = self->speed, .climb = parameters->limits.climb};
    if (self->mode == ARCADE__MODE__MODE_LANDING) {
        leg.target.z = UNDERGROUND;
        if (self->set_point.position.z < FLARE) {
            leg.climb = parameters->tuning.land_speed;
        }
    }
    return leg;
}

/* Once fixes come again, the vehicle is to stay where it then is. */
static void forget_position(navigator *self, vector position) {
    self->target = (vector){position.x, position.y, self->target.z};
    self->set_point.position = (vector){position.x, position.y, self->set_point.position.z};
    self->set_point.velocity = (vector){0.0, 0.0, self->set_point.velocity.z};
}

static bool has_landed(navigator *self, const estimate *estimate, const parameters *parameters, double elapsed) {
    double height = estimate->position.z, climb = estimate->velocity.z;
    return landing_update(&self->land_detector, height, climb, estimate->thrust, parameters, elapsed);
}

drive navigation_update(navigator *self, const estimate *estimate, const parameters *parameters, double elapsed) {
    self->in_mode += elapsed;
    bool idling = self->mode == ARCADE__MODE__MODE_TAKING_OFF && self->in_mode <= SPIN_UP;
    bool climbing = self->mode == ARCADE__MODE__MODE_TAKING_OFF && !idling;
    if ((self->mode == ARCADE__MODE__MODE_FLYING || climbing) && !estimate->position_valid) {
        land(self);
        climbing = false;
    }
    if (self->mode == ARCADE__MODE__MODE_GROUNDED) {
        return DRIVE_OFF;
    }
    if (idling) {
        self->set_point = at_rest(estimate);
        return DRIVE_IDLE;
    }
    if (climbing && fabs(self->target.z - estimate->position.z) < REACHED) {
        enter(self, ARCADE__MODE__MODE_FLYING);
    } else if (self->mode == ARCADE__MODE__MODE_LANDING && has_landed(self, estimate, parameters, elapsed)) {
        enter(self, ARCADE__MODE__MODE_GROUNDED);
        return DRIVE_OFF;
    }
    leg leg = leg_of(self, parameters);
    trajectory_advance(&self->set_point, &leg, parameters, elapsed);
    if (estimate->position_valid) {
        return DRIVE_FLY;
    }
    forget_position(self, estimate->position);
    return DRIVE_FLY_LEVEL;
}
