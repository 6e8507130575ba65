// SCL in C++: `scl_cpp client|echo`.
#include "client.h"
#include "roundtrip.scl.hpp"

#include <chrono>
#include <string>

namespace {

bool exchange(void* context) {
    static const std::string payload(BYTES, '\0');
    auto& client = *static_cast<roundtrip::Client*>(context);
    client.ping.send(payload);
    client.pong.recv();
    return true;
}

} // namespace

int main(int argc, char** argv) {
    if (argc > 1 && argv[1] == std::string("client")) {
        roundtrip::Client client;
        client.ready(std::chrono::seconds(10));
        return measure_batches(exchange, &client) ? 0 : 1;
    }
    roundtrip::Echo echo;
    for (const auto& message : echo.ping) {
        echo.pong.send(message);
    }
}
