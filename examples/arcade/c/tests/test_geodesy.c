/* Positions on the earth. */
#include "check.h"
#include "geodesy.h"
#include "tests.h"

static const home ILMENAU = {.latitude = 50.6866, .longitude = 10.9190, .altitude = 480.0};

static void there_and_back_is_where_it_was(void) {
    local_position position = {.east = 120.0, .north = -45.0, .up = 8.0};
    local_position back = geodesy_to_local(ILMENAU, geodesy_from_local(ILMENAU, position));
    CHECK_NEAR(back.east, 120.0, 1e-6);
    CHECK_NEAR(back.north, -45.0, 1e-6);
    CHECK_NEAR(back.up, 8.0, 1e-6);
}

/*
 * A degree of latitude has 110574 m at the equator and 111694 m at the pole, one of longitude 111320 m at the equator.
 */
static void degrees_have_the_length_of_tables(void) {
    home equator = {0};
    home near_pole = {.latitude = 89.999};
    CHECK_NEAR(geodesy_to_local(equator, (geodetic_position){.latitude = 1.0}).north, 110574.0, 1.0);
    CHECK_NEAR(geodesy_to_local(equator, (geodetic_position){.longitude = 1.0}).east, 111320.0, 1.0);
    CHECK_NEAR(geodesy_to_local(near_pole, (geodetic_position){.latitude = 90.999}).north, 111694.0, 1.0);
}

static void home_is_the_origin(void) {
    geodetic_position position = geodesy_from_local(ILMENAU, (local_position){.up = 5.0});
    CHECK(position.latitude == ILMENAU.latitude);
    CHECK(position.longitude == ILMENAU.longitude);
    CHECK(position.altitude == 485.0);
}

void test_geodesy(void) {
    there_and_back_is_where_it_was();
    degrees_have_the_length_of_tables();
    home_is_the_origin();
}
