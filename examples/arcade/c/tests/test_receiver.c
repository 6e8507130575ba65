/* What the receiver measures, and when. */
#include "check.h"
#include "receiver.h"
#include "tests.h"

#include <math.h>

static const receiver_parameters AT_5_HZ = {
    .rate = 5.0, .limits = {.home = {.latitude = 50.6866, .longitude = 10.9190}, .fence_radius = 100.0}};
static const outage NONE = {0};
enum { WORLD_STEP_US = 20000 }; /* 50 Hz */

/* The world at `time_us`, 10 m east, 20 m north and 5 m above home, flying east at 2 m/s. */
typedef struct scene {
    Arcade__Vector position, velocity;
    Arcade__World world;
} scene;

static Arcade__World *world_at(scene *scene, uint64_t time_us) {
    scene->position = (Arcade__Vector)ARCADE__VECTOR__INIT;
    scene->velocity = (Arcade__Vector)ARCADE__VECTOR__INIT;
    scene->world = (Arcade__World)ARCADE__WORLD__INIT;
    scene->position.x = 10.0;
    scene->position.y = 20.0;
    scene->position.z = 5.0;
    scene->velocity.x = 2.0;
    scene->world.position = &scene->position;
    scene->world.velocity = &scene->velocity;
    scene->world.time_us = time_us;
    return &scene->world;
}

/* Lets the receiver run, and returns how many fixes of 3D there were; the last one is in `fix`. */
static int run(receiver *self, const receiver_parameters *parameters, uint64_t from_us, uint64_t until_us,
               Arcade__Fix *fix) {
    scene scene;
    int found = 0;
    for (uint64_t time_us = from_us; time_us <= until_us; time_us += WORLD_STEP_US) {
        Arcade__Fix measured;
        if (receiver_measure(self, parameters, world_at(&scene, time_us), &measured)) {
            *fix = measured;
            found += measured.quality == ARCADE__FIX_QUALITY__FIX_QUALITY_3D;
        }
    }
    return found;
}

static void makes_five_fixes_a_second_after_the_first_second(void) {
    receiver self = receiver_new(1, NONE);
    Arcade__Fix fix;
    CHECK(run(&self, &AT_5_HZ, 0, 980000, &fix) == 0);
    CHECK(fix.quality == ARCADE__FIX_QUALITY__FIX_QUALITY_NONE);
    CHECK(run(&self, &AT_5_HZ, 1000000, 2980000, &fix) == 10);
    CHECK(fix.time_us == 2800000);
    CHECK(fix.satellites >= 4);
}

static void the_rate_is_a_parameter(void) {
    receiver self = receiver_new(1, NONE);
    receiver_parameters at_10_hz = AT_5_HZ;
    Arcade__Fix fix;
    at_10_hz.rate = 10.0;
    run(&self, &at_10_hz, 0, 980000, &fix);
    CHECK(run(&self, &at_10_hz, 1000000, 1980000, &fix) == 10);
}

static void errors_are_centred_and_as_large_as_they_should_be(void) {
    double east = 0.0, squares = 0.0, speed = 0.0;
    enum { RECEIVERS = 400 };
    for (int seed = 0; seed < RECEIVERS; seed++) {
        receiver self = receiver_new((uint64_t)seed, NONE);
        Arcade__Fix fix;
        run(&self, &AT_5_HZ, 0, 2000000, &fix);
        geodetic_position measured = {fix.latitude, fix.longitude, fix.altitude};
        local_position position = geodesy_to_local(AT_5_HZ.limits.home, measured);
        east += position.east - 10.0;
        squares += (position.north - 20.0) * (position.north - 20.0);
        speed += fix.east_speed;
    }
    CHECK_NEAR(east / RECEIVERS, 0.0, 0.04);
    CHECK_NEAR(sqrt(squares / RECEIVERS), hypot(0.15, 0.15), 0.03);
    CHECK_NEAR(speed / RECEIVERS, 2.0, 0.02);
}

static void an_outage_loses_the_fix(void) {
    receiver self = receiver_new(1, (outage){.from = 3.0, .until = 5.0});
    Arcade__Fix fix;
    run(&self, &AT_5_HZ, 0, 2980000, &fix);
    CHECK(run(&self, &AT_5_HZ, 3000000, 4980000, &fix) == 0);
    CHECK(fix.satellites == 0 && fix.latitude == 0.0);
    CHECK(run(&self, &AT_5_HZ, 5000000, 5980000, &fix) == 5);
}

static void a_world_that_begins_anew_switches_it_on_again(void) {
    receiver self = receiver_new(1, NONE);
    Arcade__Fix fix;
    run(&self, &AT_5_HZ, 0, 5000000, &fix);
    CHECK(run(&self, &AT_5_HZ, 0, 980000, &fix) == 0);
    CHECK(run(&self, &AT_5_HZ, 1000000, 1980000, &fix) == 5);
}

static void an_incomplete_world_is_passed_over(void) {
    receiver self = receiver_new(1, NONE);
    scene scene;
    Arcade__Fix fix;
    run(&self, &AT_5_HZ, 0, 1980000, &fix);
    Arcade__World *world = world_at(&scene, 2000000);
    world->position = NULL;
    CHECK(!receiver_measure(&self, &AT_5_HZ, world, &fix));
}

void test_receiver(void) {
    makes_five_fixes_a_second_after_the_first_second();
    the_rate_is_a_parameter();
    errors_are_centred_and_as_large_as_they_should_be();
    an_outage_loses_the_fix();
    a_world_that_begins_anew_switches_it_on_again();
    an_incomplete_world_is_passed_over();
}
