/* Random numbers that repeat. */
#include "noise.h"

#include <math.h>

static const double TWO_PI = 6.283185307179586;

noise noise_from_seed(uint64_t seed) {
    return (noise){.state = seed};
}

/* SplitMix64 (Steele, Lea and Flood, Fast Splittable Pseudorandom Number Generators, 2014). */
static uint64_t next(noise *random) {
    uint64_t z = random->state += UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return z ^ (z >> 31);
}

double noise_uniform(noise *random) {
    return (double)((next(random) >> 11) + 1) * 0x1p-53; /* the 53 bits that a double holds */
}

/* Box and Muller, A Note on the Generation of Random Normal Deviates, 1958. */
double noise_normal(noise *random) {
    double radius = sqrt(-2.0 * log(noise_uniform(random)));
    return radius * cos(TWO_PI * noise_uniform(random));
}

/* Exact for any `elapsed` (Gelb, Applied Optimal Estimation, 1974, section 2.2). */
double noise_drift(noise *random, double value, double elapsed, double sigma, double tau) {
    double kept = exp(-elapsed / tau);
    return kept * value + sigma * sqrt(1.0 - kept * kept) * noise_normal(random);
}
