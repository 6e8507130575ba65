/* The unit tests, one function for each file of the same name. */
#ifndef TESTS_H
#define TESTS_H

void test_noise(void);
void test_geodesy(void);
void test_receiver(void);
void test_parameter_table(void);
void test_resume(void);

#endif
