// The program of the link optimizer.
#include "link_optimizer.hpp"

#include <cstdio>

int main() {
    setlinebuf(stdout);
    // So that the radio can still be silenced at the end.
    scl::handle_stop();
    run(ospecorr::LinkOptimizer(), scl::stop_requested);
}
