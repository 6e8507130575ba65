// Spectrum mobility: when to fall silent, when to leave a channel, and where to go.
//
// The spectrum handoff of Akyildiz, Lee, Vuran and Mohanty, "NeXt generation/dynamic spectrum access/cognitive radio
// wireless networks: a survey", Computer Networks 50(13), 2006, as a state machine without I/O and clock.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

namespace mobility {

using Time = std::chrono::steady_clock::time_point;
using Duration = std::chrono::steady_clock::duration;
using Channel = std::uint32_t;

// How a channel was used in the past.
struct Statistics {
    double occupied = 0;  // part of the time
    double mean_idle = 0; // seconds between two occupations
};

struct Settings {
    // Without a block for this long, nobody would notice a primary user: five slots.
    Duration detector_timeout = std::chrono::milliseconds(100);
    // A primary user that pauses comes back; its channel is not chosen for this long.
    Duration avoid_left = std::chrono::seconds(5);
};

class SpectrumMobility {
  public:
    explicit SpectrumMobility(Settings settings = {}) : settings_(settings) {}

    // An application has requirements that a channel can carry.
    void start() { started_ = true; }

    // The resource map's statistics of all channels; empty while it does not answer.
    void learn(std::vector<Statistics> statistics) { statistics_ = std::move(statistics); }

    // A new block: which channels are occupied.
    void observe(Time now, std::vector<bool> occupied);

    // Time passes. To be called at least as often as decisions shall be made.
    void tick(Time now);

    // The radio does not work on this channel.
    void refused(Time now, const std::string &reason);

    // The decision: where to be, and whether to transmit there.
    std::optional<Channel> channel() const { return channel_; }
    bool transmit() const { return transmit_; }
    const std::string &reason() const { return reason_; }
    std::uint32_t changes() const { return changes_; }

  private:
    void decide(Time now);
    void leave(Time now, const std::string &why);
    void silence(const std::string &why);
    std::optional<Channel> choose(Time now, bool also_left) const;
    bool is_free(Channel channel) const;
    Statistics past(Time now, Channel channel) const;

    struct Seen {
        double blocks = 0;
        double occupied = 0;
        std::optional<Time> last_occupied;
        std::optional<Time> left;
    };

    Settings settings_;
    bool started_ = false;
    std::optional<Time> first_block_, last_block_;
    std::deque<std::vector<bool>> blocks_; // the newest three
    std::vector<Seen> seen_;
    std::vector<Statistics> statistics_;

    std::optional<Channel> channel_;
    bool transmit_ = false;
    std::string reason_ = "no application";
    std::uint32_t changes_ = 0;
};

} // namespace mobility
