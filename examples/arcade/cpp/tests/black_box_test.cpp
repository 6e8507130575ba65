// The black box beside the other ends of its gates.
#include "black_box.hpp"
#include "check.hpp"

#include <chrono>
#include <fstream>
#include <limits>
#include <sstream>

using namespace std::chrono_literals;
namespace fs = std::filesystem;

static std::string content(const fs::path& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
}

int main() {
    char name[] = "/tmp/black_box_test.XXXXXX";
    CHECK(mkdtemp(name) != nullptr);
    fs::path folder = name;
    auto [component, peer] = arcade::Blackbox::test();
    RingLog log(folder, 1 << 20);
    BlackBox black_box(log);

    arcade::Flight flight;
    flight.set_time_us(1'500'000);
    flight.mutable_position()->set_z(5);
    peer.flight.send(flight);
    arcade::Power power;
    power.set_voltage(std::numeric_limits<double>::quiet_NaN());
    peer.power.send(power);
    arcade::Record record;
    record.set_component("mission_arbiter");
    record.set_text("a \"quoted\"\nline");
    peer.records.send(record);
    for (std::uint64_t number = 1; number <= 300; number++) {
        arcade::Beat beat;
        beat.set_time_us(number * 1'000'000 / 300);
        beat.set_began_ns(number * 3'333'333);
        peer.beats.send(beat);
    }
    // What was sent may still be on its way.
    while (log.waiting() < 3 || black_box.beats().count() < 299) {
        scl::wait(component.flight, component.power, component.records, component.beats);
        black_box.drain(component);
    }
    black_box.flush();
    auto text = content(log.file(0));
    CHECK(text.find("{\"file\":1}\n") == 0);
    CHECK(text.find("{\"flight\":{\"time_us\":\"1500000\",\"position\":{\"z\":5}}}\n") != text.npos);
    CHECK(text.find("{\"power\":{\"voltage\":\"NaN\"}}\n") != text.npos);
    CHECK(text.find("{\"record\":{\"component\":\"mission_arbiter\",\"text\":\"a \\\"quoted\\\"\\nline\"}}\n") != text.npos);
    CHECK(text.find("{\"beats\":{\"periods\":299,\"p50_us\":3333,\"p99_us\":3333,\"max_us\":3333,\"late\":0,\"missing\":0}}\n") !=
          text.npos);
    CHECK(black_box.summary() == "4 lines written, 0 lost; control loop: 299 periods, p50 3.33 ms, p99 3.33 ms, max 3.33 ms, "
                                 "0 late, 0 missing");

    // A second without beats has no line of its own.
    black_box.flush();
    CHECK(log.written() == 4);

    // While the disk is full, it goes on taking records: their senders wait for it.
    fs::remove_all(folder);
    std::ofstream(folder) << "in the way";
    for (int i = 0; i < 1000; i++) {
        peer.records.send(record, 10s);
        black_box.drain(component);
        black_box.flush();
    }
    fs::remove(folder);
    while (log.written() + log.waiting() < 1004) {
        scl::wait(component.records);
        black_box.drain(component);
    }
    black_box.flush();
    CHECK(log.written() == 1004);
    CHECK(log.lost() == 0);
    fs::remove_all(folder);
}
