#include "black_box.hpp"

#include <cstdio>
#include <google/protobuf/util/json_util.h>

namespace {

/// Such as `{"power":{"time_us":"1500000","voltage":11.9,...}}`: the message as canonical protobuf JSON.
std::string line_of(const char* gate, const google::protobuf::Message& message) {
    google::protobuf::util::JsonPrintOptions options;
    options.preserve_proto_field_names = true;
    std::string json;
    if (!google::protobuf::util::MessageToJsonString(message, &json, options).ok()) {
        json = "null";
    }
    return std::string("{\"") + gate + "\":" + json + "}";
}

template <typename Gate, typename Take> void drain_gate(Gate& gate, Take take) {
    while (auto message = gate.try_recv()) {
        take(*message);
    }
}

} // namespace

void BlackBox::drain(arcade::Blackbox& component) {
    drain_gate(component.flight, [this](const auto& flight) { log_.append(line_of("flight", flight)); });
    drain_gate(component.power, [this](const auto& power) { log_.append(line_of("power", power)); });
    drain_gate(component.records, [this](const auto& record) { log_.append(line_of("record", record)); });
    drain_gate(component.beats, [this](const arcade::Beat& beat) {
        second_.add(beat.time_us(), beat.began_ns());
        total_.add(beat.time_us(), beat.began_ns());
    });
}

void BlackBox::flush() {
    if (second_.count() + second_.missing() > 0) {
        log_.append("{\"beats\":{" + second_.to_json() + "}}");
    }
    second_.clear();
    if (auto change = log_.flush()) {
        std::fprintf(stderr, "%s\n", change->c_str());
    }
}

std::string BlackBox::summary() const {
    char text[300];
    std::snprintf(text, sizeof text,
                  "%llu lines written, %llu lost; control loop: %llu periods, p50 %.2f ms, p99 %.2f ms, max %.2f ms, %llu late, "
                  "%llu missing",
                  static_cast<unsigned long long>(log_.written()), static_cast<unsigned long long>(log_.lost()),
                  static_cast<unsigned long long>(total_.count()), total_.quantile_us(0.5) / 1e3,
                  total_.quantile_us(0.99) / 1e3, total_.max_us() / 1e3, static_cast<unsigned long long>(total_.late()),
                  static_cast<unsigned long long>(total_.missing()));
    return text;
}
