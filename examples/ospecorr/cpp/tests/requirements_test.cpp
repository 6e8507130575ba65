// Which requirements are refused, and with which words.
#include "../requirements.hpp"
#include "check.hpp"

int main() {
    CHECK_EQUAL(refusal(20'000, 0.3), "");
    CHECK_EQUAL(refusal(90'000, 0.1), "");
    CHECK_EQUAL(refusal(90'001, 0.3), "90001 bytes/s are more than the 90000 bytes/s that a channel carries");
    CHECK_EQUAL(refusal(20'000, 0.05),
                "a longest gap of 0.05 s is shorter than the 0.1 s that a change of the channel takes");
    CHECK_EQUAL(refusal(20'000, NAN),
                "a longest gap of nan s is shorter than the 0.1 s that a change of the channel takes");
    CHECK_EQUAL(refusal(0, 0.3), "a rate of 0 bytes/s is not a positive number");
    CHECK_EQUAL(refusal(-1, 0.3), "a rate of -1 bytes/s is not a positive number");
    CHECK_EQUAL(refusal(NAN, 0.3), "a rate of nan bytes/s is not a positive number");
    CHECK_EQUAL(refusal(INFINITY, 0.3), "a rate of inf bytes/s is not a positive number");
    return result();
}
