/// Plays `left` or `right` of `topologies/matrix/matrix.yaml`: `matrix COMPONENT`, or, with the plan of another
/// topology, `matrix COMPONENT PLAN_FILE`. The commands are those of all programs in `languages`.

#include "matrix.scl.hpp"
#include "support.hpp"

#include <chrono>
#include <fstream>
#include <iterator>
#include <thread>

using matrix::Sample;
using support::say;
using std::chrono::milliseconds;
using Numbers = std::vector<std::uint64_t>;

/// What `right` adds to the number of a request for its reply.
static constexpr std::uint64_t reply = 1000;

static std::string text(std::uint64_t number) { return "sample " + std::to_string(number) + " ü"; }

template <class Message> static Message message(std::uint64_t number);

template <> Sample message<Sample>(std::uint64_t number) {
    Sample sample;
    sample.set_number(number);
    sample.set_text(text(number));
    return sample;
}

template <> std::string message<std::string>(std::uint64_t number) { return text(number); }

template <class Message> struct Sent {
    using type = Message;
};
template <> struct Sent<scl::Bytes> {
    using type = std::string;
};

/// Adds the number of a message to the others if its text is the right one.
static void add(Numbers& numbers, const Sample& sample) {
    if (sample.text() == text(sample.number())) {
        numbers.push_back(sample.number());
    }
}

static void add(Numbers& numbers, const scl::Bytes& bytes) {
    std::string found = bytes.to_string();
    std::uint64_t number = std::stoull(found.substr(found.find(' ') + 1));
    if (found == text(number)) {
        numbers.push_back(number);
    }
}

static std::vector<std::string> words(const std::string& line) {
    std::istringstream stream(line);
    return {std::istream_iterator<std::string>(stream), {}};
}

/// Follows the commands of the test.
template <class Follow> static void commands(Follow&& follow) {
    say("open");
    for (std::string line; std::getline(std::cin, line);) {
        auto given = words(line);
        given.resize(4);
        follow(given);
    }
}

static std::uint64_t number(const std::string& word) { return word.empty() ? 0 : std::stoull(word); }

static void say_ready(const scl::Component& component, const std::string& time) {
    support::answer([&] { return component.ready(milliseconds(number(time))), "ready"; });
}

template <class Gate> static void say_account(const Gate& gate) {
    std::string json = gate.stats();
    auto count = [&](const char* name) {
        return std::stoull(json.substr(json.find(name) + std::string_view(name).size()));
    };
    say(count("\"sent\":"), " ", count("\"received\":"), " ", count("\"rejected\":"));
}

/// Does something with the gate that has a name.
#define WITH(component, gate, action)                                                                                  \
    if (given[1] == #gate) {                                                                                           \
        action(component.gate);                                                                                        \
    }

static void play_left() {
    matrix::Left left;
    commands([&](const std::vector<std::string>& given) {
        Numbers numbers;
        auto send = [&](auto& gate) {
            using Message = typename std::remove_reference_t<decltype(gate)>::Message;
            for (std::uint64_t value = number(given[2]); value < number(given[3]); ++value) {
                gate.send(message<typename Sent<Message>::type>(value));
            }
            say("sent");
        };
        auto call = [&](auto& gate, auto sample) {
            for (std::uint64_t value = number(given[2]); value < number(given[3]); ++value) {
                add(numbers, gate.call(message<decltype(sample)>(value)));
            }
            say(support::ranges(numbers));
        };
        auto call_samples = [&](auto& gate) { call(gate, Sample()); };
        auto call_bytes = [&](auto& gate) { call(gate, std::string()); };
        auto other = [&](auto& gate) {
            if (given[0] == "account") {
                return say_account(gate);
            }
            while (gate.is_connected()) {
                std::this_thread::sleep_for(milliseconds(1));
            }
            say("gone");
        };
        if (given[0] == "ready") {
            say_ready(left, given[1]);
        } else if (given[0] == "send") {
            WITH(left, pub_protobuf, send)
            WITH(left, pub_json, send)
            WITH(left, pub_bytes, send)
            WITH(left, pub_latched_bytes, send)
            WITH(left, push_protobuf, send)
            WITH(left, push_json, send)
            WITH(left, push_bytes, send)
        } else if (given[0] == "call") {
            WITH(left, req_protobuf, call_samples)
            WITH(left, req_json, call_samples)
            WITH(left, req_bytes, call_bytes)
        } else {
            WITH(left, pub_protobuf, other)
            WITH(left, pub_json, other)
            WITH(left, pub_bytes, other)
            WITH(left, pub_latched_bytes, other)
            WITH(left, push_protobuf, other)
            WITH(left, push_json, other)
            WITH(left, push_bytes, other)
            WITH(left, req_protobuf, other)
            WITH(left, req_json, other)
            WITH(left, req_bytes, other)
        }
    });
}

static void play_right() {
    matrix::Right right;
    commands([&](const std::vector<std::string>& given) {
        Numbers numbers;
        auto each = [&](auto&& one) {
            for (std::uint64_t left = number(given[2]); left > 0; --left) {
                try {
                    one();
                } catch (const scl::DecodeError&) {
                    say("undecodable");
                }
            }
            say(support::ranges(numbers));
        };
        auto take = [&](auto& gate) {
            each([&] { add(numbers, gate.recv()); });
        };
        auto serve = [&](auto& gate, auto sample) {
            each([&] {
                auto request = gate.recv();
                Numbers one;
                add(one, request.message());
                numbers.insert(numbers.end(), one.begin(), one.end());
                request.reply(message<decltype(sample)>((one.empty() ? 0 : one.front()) + reply));
            });
        };
        auto serve_samples = [&](auto& gate) { serve(gate, Sample()); };
        auto serve_bytes = [&](auto& gate) { serve(gate, std::string()); };
        // Whether the last message is latched. Its age is an hour at most, in the right unit.
        auto age = [&](auto& gate) {
            auto age = gate.latched_age();
            bool is_right = age && age->count() > 0 && *age < std::chrono::hours(1);
            say(!age ? "new" : is_right ? "latched" : "wrong age");
        };
        auto account = [&](auto& gate) { say_account(gate); };
        if (given[0] == "ready") {
            say_ready(right, given[1]);
        } else if (given[0] == "take") {
            WITH(right, sub_protobuf, take)
            WITH(right, sub_json, take)
            WITH(right, sub_bytes, take)
            WITH(right, sub_latched_bytes, take)
            WITH(right, pull_protobuf, take)
            WITH(right, pull_json, take)
            WITH(right, pull_bytes, take)
        } else if (given[0] == "serve") {
            WITH(right, rep_protobuf, serve_samples)
            WITH(right, rep_json, serve_samples)
            WITH(right, rep_bytes, serve_bytes)
        } else if (given[0] == "age") {
            WITH(right, sub_latched_bytes, age)
        } else {
            WITH(right, sub_protobuf, account)
            WITH(right, sub_json, account)
            WITH(right, sub_bytes, account)
            WITH(right, pull_protobuf, account)
            WITH(right, pull_json, account)
            WITH(right, pull_bytes, account)
            WITH(right, rep_protobuf, account)
            WITH(right, rep_json, account)
            WITH(right, rep_bytes, account)
        }
    });
}

/// Only opens, and tells why it does not find its peers.
static void play_plan(const char* name, const char* path) {
    std::ifstream file(path);
    std::string plan{std::istreambuf_iterator<char>(file), {}};
    scl::Component component(plan, name);
    commands([&](const std::vector<std::string>& given) { say_ready(component, given[1]); });
}

int main(int count, char** arguments) {
    if (count > 2) {
        play_plan(arguments[1], arguments[2]);
    } else if (std::string(arguments[1]) == "left") {
        play_left();
    } else {
        play_right();
    }
}
