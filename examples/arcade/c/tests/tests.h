/* The unit tests, one function for each file of the same name. */
#ifndef TESTS_H
#define TESTS_H

#include "parameters.h"

/* The defaults of the topology. */
parameters parameters_default(void);

void test_noise(void);
void test_geodesy(void);
void test_receiver(void);
void test_resume(void);
void test_quaternion(void);
void test_attitude(void);
void test_position(void);
void test_trajectory(void);
void test_control(void);
void test_mixer(void);
void test_landing(void);
void test_commands(void);
void test_pending(void);
void test_navigation(void);
void test_flight_controller(void);
void test_beats(void);

#endif
