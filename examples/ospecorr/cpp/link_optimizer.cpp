// The link optimizer, see the header.
#include "link_optimizer.hpp"

#include "requirements.hpp"
#include "spectrum_mobility.hpp"
#include "statistics_reader.hpp"

#include <cstdio>

using namespace std::chrono_literals;
using mobility::SpectrumMobility;
using mobility::Time;

namespace {

constexpr auto turn = 20ms; // the longest time without a look at the clock: one slot
constexpr auto publish_every = 100ms;
// The radio falls silent when its configuration is not repeated for 500 ms. Repeating it often also reaches a radio
// that was restarted, which does not know its channel.
constexpr auto configure_every = 50ms;

std::vector<bool> occupied_channels(const ospecorr::Occupancy &occupancy) {
    std::vector<bool> occupied;
    for (const auto &channel : occupancy.channels()) {
        occupied.push_back(channel.occupied());
    }
    return occupied;
}

// Tells the radio what was decided: at once after a change, and again and again.
class RadioControl {
  public:
    explicit RadioControl(scl::Req<ospecorr::Configuration, ospecorr::Configured> &gate) : gate_(gate) {}

    void apply(Time now, SpectrumMobility &mobility) {
        auto wanted = std::pair(mobility.channel().value_or(0), mobility.transmit());
        if (is_applied_ && wanted == applied_ && now - applied_at_ < configure_every) {
            return;
        }
        // Without a radio a call only waits, and it is silent anyway.
        if (!gate_.is_connected()) {
            is_applied_ = false;
            return;
        }
        ospecorr::Configuration configuration;
        configuration.set_channel(wanted.first);
        configuration.set_transmit(wanted.second);
        std::error_code error;
        auto configured = gate_.call(configuration, error);
        is_applied_ = configured && configured->accepted();
        if (is_applied_) {
            if (failed_) {
                std::printf("the radio is configured again\n");
            }
            applied_ = wanted;
            applied_at_ = now;
        } else if (configured) {
            mobility.refused(now, configured->reason());
        } else if (!failed_) {
            std::printf("the radio is not configured: %s\n", scl::last_error());
        }
        failed_ = !configured;
    }

  private:
    scl::Req<ospecorr::Configuration, ospecorr::Configured> &gate_;
    std::pair<mobility::Channel, bool> applied_;
    bool is_applied_ = false;
    Time applied_at_;
    bool failed_ = false;
};

// Publishes the state of the link, ten times a second and when it changes.
class LinkReport {
  public:
    explicit LinkReport(scl::Pub<ospecorr::LinkState> &gate) : gate_(gate) {}

    void publish(Time now, std::uint64_t time_us, const SpectrumMobility &mobility) {
        auto state = std::tuple(mobility.channel(), mobility.transmit(), mobility.reason());
        bool changed = state != published_;
        if (!changed && now - published_at_ < publish_every) {
            return;
        }
        ospecorr::LinkState link;
        link.set_time_us(time_us);
        link.set_channel(mobility.channel().value_or(0));
        link.set_transmit(mobility.transmit());
        link.set_reason(mobility.reason());
        link.set_changes(mobility.changes());
        gate_.send(link);
        if (changed) {
            std::printf("%s: %s\n", describe(mobility).c_str(), mobility.reason().c_str());
        }
        published_ = state;
        published_at_ = now;
    }

  private:
    static std::string describe(const SpectrumMobility &mobility) {
        return mobility.transmit() ? "channel " + std::to_string(*mobility.channel()) : "silent";
    }

    scl::Pub<ospecorr::LinkState> &gate_;
    std::optional<std::tuple<std::optional<mobility::Channel>, bool, std::string>> published_;
    Time published_at_;
};

ospecorr::RequirementsResult judge(const ospecorr::Requirements &requirements) {
    ospecorr::RequirementsResult result;
    result.set_reason(refusal(requirements.rate(), requirements.longest_gap()));
    result.set_accepted(result.reason().empty());
    return result;
}

} // namespace

void run(ospecorr::LinkOptimizer optimizer, const std::function<bool()> &is_stopped) {
    SpectrumMobility mobility;
    StatisticsReader statistics(std::move(optimizer.map));
    RadioControl radio(optimizer.radio);
    LinkReport report(optimizer.link);
    std::uint64_t time_us = 0;
    while (!is_stopped()) {
        scl::wait(turn, optimizer.occupancy, optimizer.requirements);
        auto now = std::chrono::steady_clock::now();
        mobility.learn(statistics.newest());
        if (auto occupancy = optimizer.occupancy.try_recv()) {
            time_us = occupancy->time_us();
            mobility.observe(now, occupied_channels(*occupancy));
        }
        if (auto request = optimizer.requirements.try_recv()) {
            auto result = judge(request->message());
            if (result.accepted()) {
                mobility.start();
            }
            std::error_code gone; // an application that was stopped no longer waits for the reply
            request->reply(result, gone);
        }
        mobility.tick(now);
        radio.apply(now, mobility);
        report.publish(now, time_us, mobility);
    }
    ospecorr::Configuration silent;
    std::error_code error; // a radio that is gone is silent, too
    optimizer.radio.call(silent, error);
}
