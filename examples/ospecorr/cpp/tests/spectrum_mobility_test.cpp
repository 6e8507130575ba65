// Spectrum mobility: tables of blocks and the decisions that they lead to.
#include "../spectrum_mobility.hpp"
#include "check.hpp"

using namespace mobility;
using namespace std::chrono_literals;

namespace {

constexpr auto block_period = 20ms;

// What the detector found in each channel (`x` is occupied; empty: no block came), and the decision that follows, such
// as `2 on`: the channel, and whether the radio transmits there.
struct Step {
    std::string block;
    std::string expected;
    int times = 1;
};

std::string decision(const SpectrumMobility &mobility) {
    auto channel = mobility.channel();
    return (channel ? std::to_string(*channel) : "-") + (mobility.transmit() ? " on" : " off");
}

std::vector<bool> occupied(const std::string &block) {
    std::vector<bool> channels;
    for (char channel : block) {
        channels.push_back(channel == 'x');
    }
    return channels;
}

Time now{1h};

void play(const char *name, SpectrumMobility &mobility, const std::vector<Step> &steps) {
    int number = 0;
    for (const auto &step : steps) {
        number++;
        for (int i = 0; i < step.times; i++) {
            now += block_period;
            if (!step.block.empty()) {
                mobility.observe(now, occupied(step.block));
            }
            mobility.tick(now);
        }
        if (decision(mobility) != step.expected) {
            std::cerr << name << ", step " << number << " (" << mobility.reason() << "):\n";
        }
        CHECK_EQUAL(decision(mobility), step.expected);
    }
}

void play(const char *name, const std::vector<Step> &steps, std::vector<Statistics> statistics = {}) {
    SpectrumMobility mobility;
    mobility.start();
    mobility.learn(std::move(statistics));
    play(name, mobility, steps);
}

// Channel 1 is the best one, then 2, then 0.
const std::vector<Statistics> map = {{0.5, 1}, {0, 60}, {0.1, 10}};

void moves() {
    play("start on the best free channel", {{"...", "1 on"}}, map);
    play("start beside a primary user", {{".x.", "2 on"}}, map);
    play("start when no channel is free", {{"xxx", "- off"}, {"xxx", "- off"}, {".xx", "- off", 2}, {".xx", "0 on"}},
         map);
    play("a false alarm costs one slot", {{"...", "1 on"}, {".x.", "1 off"}, {"...", "1 on"}, {"...", "1 on"}}, map);
    play("two blocks in succession", {{"...", "1 on"}, {".x.", "1 off"}, {".x.", "2 on"}, {".x.", "2 on", 500}}, map);
    play("two of three blocks", {{"...", "1 on"}, {".x.", "1 off"}, {"...", "1 on"}, {".x.", "2 on"}}, map);
    play("two of four blocks", {{"...", "1 on"}, {".x.", "1 off"}, {"...", "1 on", 2}, {".x.", "1 off"}}, map);
    play("no false alarm in the next channel", {{"...", "1 on"}, {".x.", "1 off"}, {".xx", "0 on"}}, map);
    play("a primary user in another channel", {{"...", "1 on"}, {"x.x", "1 on", 10}}, map);
    play("not back at once",
         {{"...", "1 on"}, {".x.", "1 off"}, {".x.", "2 on"}, {"...", "2 on", 10}, {"..x", "2 off"}, {"..x", "0 on"}},
         map);
    play("back after five seconds",
         {{"...", "1 on"}, {".x.", "1 off"}, {".x.", "2 on"}, {"...", "2 on", 250}, {"..x", "2 off"}, {"..x", "1 on"}},
         map);
    play("back at once if nothing else is free",
         {{"...", "1 on"}, {".x.", "1 off"}, {".x.", "2 on"}, {"x..", "2 on", 3}, {"x.x", "2 off"}, {"x.x", "1 on"}},
         map);
    play("wait for a free channel", {{"...", "1 on"}, {"xxx", "1 off", 4}, {"xx.", "1 off", 2}, {"xx.", "2 on"}}, map);
    play("another division of the band", {{"...", "1 on"}, {"xxxx.", "4 on"}}, map);
}

void silent_detector() {
    play("four blocks are missing", {{"...", "1 on"}, {"", "1 on", 4}, {"...", "1 on"}}, map);
    play("five blocks are missing", {{"...", "1 on"}, {"", "1 off", 5}, {"", "1 off", 100}, {"...", "1 on"}}, map);
    play("occupied meanwhile", {{"...", "1 on"}, {"", "1 off", 5}, {".x.", "1 off"}, {".x.", "2 on"}}, map);
    play("no block yet", {{"", "- off"}});
}

void statistics() {
    play("equally occupied: the longer pauses", {{"...", "2 on"}}, {{0.20, 5}, {0.22, 4}, {0.21, 6}});
    play("without the map: what was seen here",
         {{"...", "0 on"}, {"..x", "0 on", 20}, {"...", "0 on", 100}, {"x..", "0 off"}, {"x..", "1 on"}});
    play("without the map: the longer pause",
         {{"...", "0 on", 100}, {".x.", "0 on"}, {"...", "0 on", 100}, {"x..", "0 off"}, {"x..", "2 on"}});
    // A map of a smaller band says nothing about the rest of it.
    play("statistics for some channels", {{"xx.", "2 on"}}, {{0.1, 1}});
}

void application() {
    SpectrumMobility mobility;
    play("without an application", mobility, {{"...", "- off", 5}});
    CHECK_EQUAL(mobility.reason(), "no application");
    mobility.start();
    play("with one", mobility, {{"...", "0 on"}});
    CHECK_EQUAL(mobility.reason(), "start");
}

void reasons() {
    SpectrumMobility mobility;
    mobility.start();
    mobility.learn(map);
    mobility.tick(now);
    CHECK_EQUAL(mobility.reason(), "the signal detector has not sent a block yet");
    play("reasons", mobility, {{"...", "1 on"}, {".x.", "1 off"}});
    CHECK_EQUAL(mobility.reason(), "channel 1 may be occupied");
    play("reasons", mobility, {{".x.", "2 on"}});
    CHECK_EQUAL(mobility.reason(), "channel 1 is occupied");
    CHECK_EQUAL(mobility.changes(), 1u);
    play("reasons", mobility, {{"xxx", "2 off", 2}});
    CHECK_EQUAL(mobility.reason(), "channel 2 is occupied, and no channel is free");
    play("reasons", mobility, {{"", "2 off", 5}});
    CHECK_EQUAL(mobility.reason(), "no block from the signal detector for 100 ms");
    play("reasons", mobility, {{"...", "2 on"}});
    mobility.refused(now, "broken");
    CHECK_EQUAL(mobility.reason(), "the radio refuses channel 2: broken");
    CHECK_EQUAL(decision(mobility), "0 on");
    CHECK_EQUAL(mobility.changes(), 2u);
}

void no_channels() {
    SpectrumMobility mobility;
    mobility.start();
    mobility.observe(now, {});
    CHECK_EQUAL(decision(mobility), "- off");
    play("a band without channels", mobility, {{"...", "0 on"}});
}

} // namespace

int main() {
    no_channels();
    moves();
    silent_detector();
    statistics();
    application();
    reasons();
    return result();
}
