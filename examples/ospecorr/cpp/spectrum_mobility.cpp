// Spectrum mobility, see the header.
#include "spectrum_mobility.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace mobility {
namespace {

constexpr std::size_t window = 3; // blocks

// Own statistics forget blocks: one of 500 blocks ago (10 s) counts a third.
constexpr double memory = 1 - 1.0 / 500;

double seconds(Duration duration) { return std::chrono::duration<double>(duration).count(); }

std::string name(Channel channel) { return "channel " + std::to_string(channel); }

std::string milliseconds(Duration duration) {
    return std::to_string(std::chrono::duration_cast<std::chrono::milliseconds>(duration).count()) + " ms";
}

} // namespace

void SpectrumMobility::observe(Time now, std::vector<bool> occupied) {
    if (occupied.size() != seen_.size()) {
        // Another division of the band: nothing of the past applies.
        seen_.assign(occupied.size(), {});
        blocks_.clear();
        first_block_ = now;
        channel_.reset();
    }
    for (std::size_t i = 0; i < occupied.size(); i++) {
        seen_[i].blocks = seen_[i].blocks * memory + 1;
        seen_[i].occupied = seen_[i].occupied * memory + (occupied[i] ? 1 : 0);
        if (occupied[i]) {
            seen_[i].last_occupied = now;
        }
    }
    last_block_ = now;
    blocks_.push_back(std::move(occupied));
    if (blocks_.size() > window) {
        blocks_.pop_front();
    }
    decide(now);
}

void SpectrumMobility::tick(Time now) {
    if (!last_block_ || now - *last_block_ >= settings_.detector_timeout) {
        // What was seen before a pause says nothing about the time after it.
        blocks_.clear();
        silence(last_block_ ? "no block from the signal detector for " + milliseconds(settings_.detector_timeout)
                            : "the signal detector has not sent a block yet");
    }
}

void SpectrumMobility::refused(Time now, const std::string &reason) {
    if (channel_) {
        leave(now, "the radio refuses " + name(*channel_) + ": " + reason);
    }
}

void SpectrumMobility::decide(Time now) {
    if (!started_) {
        silence("no application");
        return;
    }
    if (!channel_) {
        leave(now, "start");
        return;
    }
    if (!blocks_.back()[*channel_]) {
        if (!transmit_) {
            transmit_ = true;
            reason_ = name(*channel_) + " is free";
        }
        return;
    }
    // One decision of the detector is enough to fall silent: that protects the primary user, and costs one slot. It
    // takes a second one of three to leave: a single one may be a false alarm, and a primary user that pauses for a
    // block is still there.
    auto alarms =
        std::count_if(blocks_.begin(), blocks_.end(), [&](const auto &block) { return bool(block[*channel_]); });
    if (alarms >= 2) {
        leave(now, name(*channel_) + " is occupied");
    } else {
        silence(name(*channel_) + " may be occupied");
    }
}

void SpectrumMobility::leave(Time now, const std::string &why) {
    if (channel_) {
        seen_[*channel_].left = now;
    }
    auto next = choose(now, false);
    if (!next) {
        // Better a channel that was left a moment ago than none.
        next = choose(now, true);
    }
    if (!next) {
        silence(why + ", and no channel is free");
        return;
    }
    if (channel_ && channel_ != next) {
        changes_++;
    }
    channel_ = next;
    transmit_ = true;
    reason_ = why;
}

void SpectrumMobility::silence(const std::string &why) {
    transmit_ = false;
    reason_ = why;
}

// The free channel that is used least; among equal ones, that with the longest pauses.
std::optional<Channel> SpectrumMobility::choose(Time now, bool also_left) const {
    std::optional<Channel> best;
    std::tuple<double, double> best_cost;
    for (Channel candidate = 0; candidate < seen_.size(); candidate++) {
        const auto &left = seen_[candidate].left;
        if (!is_free(candidate) || (left && !also_left && now - *left < settings_.avoid_left)) {
            continue;
        }
        auto [occupied, mean_idle] = past(now, candidate);
        // Differences below a twentieth are chance, and shall not outweigh the pauses.
        std::tuple<double, double> cost{std::round(occupied * 20), -mean_idle};
        if (!best || cost < best_cost) {
            best = candidate;
            best_cost = cost;
        }
    }
    return best;
}

bool SpectrumMobility::is_free(Channel channel) const {
    return !blocks_.empty() &&
           std::none_of(blocks_.begin(), blocks_.end(), [&](const auto &block) { return bool(block[channel]); });
}

// From the resource map, or from what was seen here if the map does not answer.
Statistics SpectrumMobility::past(Time now, Channel channel) const {
    if (channel < statistics_.size()) {
        return statistics_[channel];
    }
    const auto &seen = seen_[channel];
    auto idle_since = seen.last_occupied.value_or(first_block_.value_or(now));
    return {seen.blocks > 0 ? seen.occupied / seen.blocks : 0, seconds(now - idle_since)};
}

} // namespace mobility
