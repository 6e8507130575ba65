/* Random numbers that repeat: the same seed gives the same noise on every machine. */
#ifndef NOISE_H
#define NOISE_H

#include <stdint.h>

typedef struct noise {
    uint64_t state;
} noise;

noise noise_from_seed(uint64_t seed);

/* Evenly distributed, above 0 and at most 1. */
double noise_uniform(noise *random);

/* Normally distributed with mean 0 and standard deviation 1. */
double noise_normal(noise *random);

/*
 * The next value of a slow error, `elapsed` seconds after `value`: a first-order Gauss-Markov process with standard
 * deviation `sigma` and correlation time `tau` in seconds.
 */
double noise_drift(noise *random, double value, double elapsed, double sigma, double tau);

#endif
