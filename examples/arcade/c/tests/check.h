/* A harness of assertions: a failed one prints its place and its values, and the tests go on. */
#ifndef CHECK_H
#define CHECK_H

#include <stdbool.h>

#define CHECK(condition) check_that((condition), __FILE__, __LINE__, #condition)
#define CHECK_NEAR(value, expected, within) check_near((value), (expected), (within), __FILE__, __LINE__, #value)

void check_that(bool condition, const char *file, int line, const char *text);
void check_near(double value, double expected, double within, const char *file, int line, const char *text);

#endif
