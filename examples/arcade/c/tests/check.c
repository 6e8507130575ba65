/* Runs all unit tests. Exit code 1 if one fails. */
#include "check.h"
#include "tests.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static unsigned checked, failed;

void check_that(bool condition, const char *file, int line, const char *text) {
    checked++;
    if (!condition) {
        failed++;
        fprintf(stderr, "%s:%d: `%s` is false\n", file, line, text);
    }
}

void check_near(double value, double expected, double within, const char *file, int line, const char *text) {
    checked++;
    if (!(fabs(value - expected) <= within)) { /* also if it is not a number */
        failed++;
        fprintf(stderr, "%s:%d: `%s` is %.9g, not %.9g within %g\n", file, line, text, value, expected, within);
    }
}

int main(void) {
    /* Tests close components as a crash does, with messages left, which would be warnings. */
    setenv("SCL_LOG", "error", 0);
    test_noise();
    test_geodesy();
    test_receiver();
    test_resume();
    test_quaternion();
    test_attitude();
    test_position();
    test_trajectory();
    test_control();
    test_mixer();
    test_landing();
    test_commands();
    test_pending();
    test_navigation();
    test_flight_controller();
    test_beats();
    printf("%u checks, %u failed\n", checked, failed);
    return failed == 0 ? 0 : 1;
}
