/* Statistics of the noise. */
#include "check.h"
#include "noise.h"
#include "tests.h"

#include <math.h>

enum { DRAWN = 100000 };

static void normal_numbers_have_mean_0_and_deviation_1(void) {
    noise random = noise_from_seed(7);
    double sum = 0.0, squares = 0.0;
    for (int i = 0; i < DRAWN; i++) {
        double value = noise_normal(&random);
        sum += value;
        squares += value * value;
    }
    CHECK_NEAR(sum / DRAWN, 0.0, 0.02);
    CHECK_NEAR(sqrt(squares / DRAWN), 1.0, 0.02);
}

static void a_seed_repeats_its_numbers(void) {
    noise first = noise_from_seed(3), same = noise_from_seed(3), other = noise_from_seed(4);
    double value = noise_normal(&first);
    CHECK(value == noise_normal(&same));
    CHECK(value != noise_normal(&other));
}

/* The autocorrelation of a first-order Gauss-Markov process falls by e within its correlation time. */
static void drift_keeps_its_deviation_and_correlation(void) {
    noise random = noise_from_seed(11);
    double value = 0.0, squares = 0.0, products = 0.0;
    for (int i = 0; i < DRAWN; i++) {
        double next = noise_drift(&random, value, 0.5, 2.0, 1.0);
        products += value * next;
        squares += next * next;
        value = next;
    }
    CHECK_NEAR(sqrt(squares / DRAWN), 2.0, 0.05);
    CHECK_NEAR(products / squares, exp(-0.5), 0.02);
}

void test_noise(void) {
    normal_numbers_have_mean_0_and_deviation_1();
    a_seed_repeats_its_numbers();
    drift_keeps_its_deviation_and_correlation();
}
