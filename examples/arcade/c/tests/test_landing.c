/* When the vehicle has landed. */
#include "check.h"
#include "landing.h"
#include "tests.h"

/* After how many of 300 beats the detector fires; 0 if it does not. */
static int beats(double height, double climb, double thrust) {
    parameters parameters = parameters_default();
    land_detector self = {0};
    for (int beat = 1; beat <= 300; beat++) {
        if (landing_update(&self, height, climb, thrust, &parameters, 1.0 / 300.0)) {
            return beat;
        }
    }
    return 0;
}

void test_landing(void) {
    CHECK_NEAR(beats(0.1, 0.0, 0.1), 150, 1.0); /* standing for half a second */
    CHECK(beats(0.1, 0.0, 0.45) == 0);          /* hovering */
    CHECK(beats(0.1, -0.5, 0.1) == 0);          /* sinking */
    CHECK(beats(3.0, 0.0, 0.1) == 0);           /* falling */
}
