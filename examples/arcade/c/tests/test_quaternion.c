/* Rotations. */
#include "check.h"
#include "quaternion.h"
#include "tests.h"

#define CHECK_VECTOR(value, expected) CHECK(vector_length(vector_subtract((value), (expected))) < 1e-12)

static void angles_survive_the_way_there_and_back(void) {
    vector angles = {0.3, -0.7, 2.5};
    CHECK_VECTOR(quaternion_angles(quaternion_from_angles(angles)), angles);
}

/*
 * x forward, y left, z up: positive pitch lowers the nose, positive roll raises the left side, positive yaw turns left.
 */
static void angles_turn_as_the_schema_says(void) {
    vector nose = quaternion_rotate(quaternion_from_angles((vector){.y = 0.1}), (vector){.x = 1.0});
    vector left = quaternion_rotate(quaternion_from_angles((vector){.x = 0.1}), (vector){.y = 1.0});
    vector ahead = quaternion_rotate(quaternion_from_angles((vector){.z = 0.1}), (vector){.x = 1.0});
    CHECK(nose.z < 0.0);
    CHECK(left.z > 0.0);
    CHECK(ahead.y > 0.0);
}

static void a_rotation_vector_survives_the_way_there_and_back(void) {
    static const vector ROTATIONS[] = {{0.4, -1.2, 0.3}, {1e-12, 0.0, 0.0}, {0.0, 0.0, 0.0}};
    for (size_t i = 0; i < 3; i++) {
        CHECK_VECTOR(quaternion_rotation_vector(quaternion_from_rotation_vector(ROTATIONS[i])), ROTATIONS[i]);
    }
}

static void the_shorter_way_is_taken(void) {
    vector rotation = quaternion_rotation_vector(quaternion_from_rotation_vector((vector){.z = 6.0}));
    CHECK_NEAR(rotation.z, 6.0 - 2.0 * 3.141592653589793, 1e-12);
}

static void a_product_rotates_by_the_second_factor_first(void) {
    quaternion turn = quaternion_from_angles((vector){.z = 1.0}), tilt = quaternion_from_angles((vector){.x = 0.2});
    vector v = {1.0, 2.0, 3.0};
    CHECK_VECTOR(quaternion_rotate(quaternion_multiply(turn, tilt), v), quaternion_rotate(turn,
                                                                                          quaternion_rotate(tilt, v)));
    CHECK_VECTOR(quaternion_rotate(quaternion_multiply(turn, quaternion_conjugate(turn)), v), v);
}

void test_quaternion(void) {
    angles_survive_the_way_there_and_back();
    angles_turn_as_the_schema_says();
    a_rotation_vector_survives_the_way_there_and_back();
    the_shorter_way_is_taken();
    a_product_rotates_by_the_second_factor_first();
}
