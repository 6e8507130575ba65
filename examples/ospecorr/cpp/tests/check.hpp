// CHECK_EQUAL: the little that these tests need of a test framework.
#pragma once

#include <iostream>

inline int failures = 0;

#define CHECK_EQUAL(actual, expected) check_equal((actual), (expected), #actual, __FILE__, __LINE__)

template <class Actual, class Expected>
void check_equal(const Actual &actual, const Expected &expected, const char *text, const char *file, int line) {
    if (!(actual == expected)) {
        std::cerr << file << ":" << line << ": " << text << " is `" << actual << "`, expected `" << expected << "`\n";
        failures++;
    }
}

// The exit code of a test program.
inline int result() { return failures == 0 ? 0 : 1; }
