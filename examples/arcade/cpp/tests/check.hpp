/// CHECK: like assert, but also in release builds, and with a message.
#pragma once

#include <cstdio>
#include <cstdlib>

#define CHECK(condition)                                                                                                       \
    do {                                                                                                                       \
        if (!(condition)) {                                                                                                    \
            std::fprintf(stderr, "%s:%d: not true: %s\n", __FILE__, __LINE__, #condition);                                     \
            std::exit(1);                                                                                                      \
        }                                                                                                                      \
    } while (false)
