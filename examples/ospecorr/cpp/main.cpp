// The program of the link optimizer.
#include "link_optimizer.hpp"

#include <cstdio>

int main() {
    setlinebuf(stdout);
    run(ospecorr::LinkOptimizer());
}
