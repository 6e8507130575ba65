// The link optimizer beside the other ends of its gates.
#include "../link_optimizer.hpp"
#include "check.hpp"

#include <atomic>
#include <string>
#include <thread>

using namespace std::chrono_literals;

namespace {

// Channel 1 is the best one, then 2, then 0.
const double occupied_part[] = {0.5, 0, 0.1};

// A running link optimizer. The test is its detector, its radio, its resource map and its application.
class Running {
  public:
    ospecorr::LinkOptimizerPeer peer;

    Running() : Running(ospecorr::LinkOptimizer::test()) {}

    ~Running() {
        ending_ = true;
        // The last thing that it does is to silence the radio, which ends the call that waits for a reply.
        while (next_configuration() != "0 off") {
        }
        thread_.join();
    }

    // Asks for a rate; returns why it is refused, or an empty text.
    std::string require(double rate) {
        ospecorr::Requirements requirements;
        requirements.set_rate(rate);
        requirements.set_longest_gap(0.2);
        auto result = peer.requirements.call(requirements, 60s);
        CHECK_EQUAL(result.accepted(), result.reason().empty());
        return result.reason();
    }

    // Answers the queries for statistics. The second one shows that the first answer has been taken.
    void learn() {
        ospecorr::Statistics statistics;
        for (double occupied : occupied_part) {
            statistics.add_channels()->set_occupied(occupied);
        }
        for (int i = 0; i < 2; i++) {
            peer.map.recv().reply(statistics);
        }
    }

    // Sends a block (`x` is occupied) again and again, until the radio is configured like this: `2 on` is to transmit
    // on channel 2.
    void observe_until(const std::string &block, const std::string &expected) {
        do {
            ospecorr::Occupancy occupancy;
            occupancy.set_time_us(time_us_ += 20'000);
            for (char channel : block) {
                occupancy.add_channels()->set_occupied(channel == 'x');
            }
            peer.occupancy.send(occupancy);
        } while (next_configuration() != expected);
    }

    // Takes the next configuration of the radio, and accepts it unless it is for a channel that the radio does not
    // have.
    std::string next_configuration() {
        auto request = peer.radio.recv();
        bool accepted = request->channel() != missing_channel || !request->transmit();
        ospecorr::Configured configured;
        configured.set_accepted(accepted);
        configured.set_reason(accepted ? "" : "no such channel");
        std::error_code late; // a call that has timed out
        request.reply(configured, late);
        return std::to_string(request->channel()) + (request->transmit() ? " on" : " off");
    }

    // Reads the states of the link up to one with this reason.
    ospecorr::LinkState link_with(const std::string &reason) {
        while (true) {
            auto link = peer.link.recv();
            if (link.reason() == reason) {
                return link;
            }
        }
    }

    std::uint32_t missing_channel = 99;

  private:
    explicit Running(std::pair<ospecorr::LinkOptimizer, ospecorr::LinkOptimizerPeer> opened)
        : peer(std::move(opened.second)), thread_([this, optimizer = std::move(opened.first)]() mutable {
              run(std::move(optimizer), [this] { return ending_.load(); });
          }) {}

    std::uint64_t time_us_ = 0;
    std::atomic<bool> ending_ = false;
    std::thread thread_;
};

void requirements_are_judged() {
    Running optimizer;
    CHECK_EQUAL(optimizer.require(1e6), "1000000 bytes/s are more than the 90000 bytes/s that a channel carries");
    CHECK_EQUAL(optimizer.require(20'000), "");
}

void it_moves_to_the_best_channel_of_the_map() {
    Running optimizer;
    optimizer.learn();
    optimizer.observe_until("...", "0 off");
    CHECK_EQUAL(optimizer.require(20'000), "");
    optimizer.observe_until("...", "1 on");
    optimizer.observe_until(".x.", "2 on");
    auto link = optimizer.link_with("channel 1 is occupied");
    CHECK_EQUAL(link.channel(), 2u);
    CHECK_EQUAL(link.transmit(), true);
    CHECK_EQUAL(link.changes(), 1u);
    CHECK_EQUAL(link.time_us() % 20'000, 0u);
}

void without_a_map_it_moves_all_the_same() {
    Running optimizer;
    CHECK_EQUAL(optimizer.require(20'000), "");
    optimizer.observe_until("...", "0 on");
    optimizer.observe_until("x..", "1 on");
}

void without_a_detector_the_radio_is_silenced() {
    Running optimizer;
    CHECK_EQUAL(optimizer.require(20'000), "");
    optimizer.observe_until("...", "0 on");
    while (optimizer.next_configuration() != "0 off") {
    }
    CHECK_EQUAL(optimizer.link_with("no block from the signal detector for 100 ms").transmit(), false);
    optimizer.observe_until("...", "0 on");
}

void a_configuration_without_reply_is_repeated() {
    Running optimizer;
    for (int i = 0; i < 3; i++) {
        CHECK_EQUAL(optimizer.peer.radio.recv()->transmit(), false);
    }
    CHECK_EQUAL(optimizer.next_configuration(), "0 off");
}

void a_channel_that_the_radio_refuses_is_left() {
    Running optimizer;
    optimizer.missing_channel = 0;
    CHECK_EQUAL(optimizer.require(20'000), "");
    optimizer.observe_until("...", "0 on");
    optimizer.observe_until("...", "1 on");
}

} // namespace

int main() {
    requirements_are_judged();
    it_moves_to_the_best_channel_of_the_map();
    without_a_map_it_moves_all_the_same();
    without_a_detector_the_radio_is_silenced();
    a_configuration_without_reply_is_repeated();
    a_channel_that_the_radio_refuses_is_left();
    return result();
}
