/// Plays a component of `six_kinds.yaml` and follows the commands of `tests/src/bin/peer.rs`: `peer source`, `peer
/// sink`.

#include "six.scl.hpp"
#include "support.hpp"

using support::answer;
using support::Command;
using support::say;
using test::Number;

static Number message(std::uint64_t value, std::uint64_t padding = 0) {
    Number number;
    number.set_value(value);
    number.set_padding(std::string(padding, '\7'));
    return number;
}

static int play_source() {
    six::Source source;
    say("open");
    for (Command command; command.read();) {
        std::uint64_t from = command.number(1), to = command.number(2), padding = command.number(3);
        if (command.is("ready")) {
            answer([&] { return source.ready(std::chrono::milliseconds(from)), "ready"; });
        } else if (command.is("publish")) {
            for (std::uint64_t value = from; value < to; ++value) {
                source.readings.send(message(value, padding));
            }
            say("published");
        } else if (command.is("lossless")) {
            for (std::uint64_t value = from; value < to; ++value) {
                source.lossless.send(message(value, padding));
            }
            say("published");
        } else if (command.is("try_lossless")) {
            say(source.lossless.try_send(message(from)) ? "published" : "full");
        } else if (command.is("lossless_within")) {
            answer([&] { return source.lossless.send(message(from), std::chrono::milliseconds(to)), "published"; });
        } else if (command.is("push")) {
            for (std::uint64_t value = from; value < to; ++value) {
                source.jobs.send(message(value, padding));
            }
            say("pushed");
        } else if (command.is("call")) {
            answer([&] { return source.question.call(message(from)).value(); });
        } else if (command.is("call_within")) {
            answer([&] { return source.question.call(message(from), std::chrono::milliseconds(to)).value(); });
        } else {
            say("unknown command");
        }
    }
    // The destructor hands over what was sent.
    return 0;
}

template <class Gate> static void receive(Gate& gate, std::uint64_t count) {
    std::vector<std::uint64_t> values;
    while (values.size() < count) {
        values.push_back(gate.recv().value());
    }
    say(support::ranges(values));
}

static int play_sink() {
    six::Sink sink;
    say("open");
    std::vector<scl::Request<Number, Number>> unanswered;
    for (Command command; command.read();) {
        std::uint64_t count = command.number(1);
        if (command.is("ready")) {
            answer([&] { return sink.ready(std::chrono::milliseconds(count)), "ready"; });
        } else if (command.is("receive")) {
            receive(sink.readings, count);
        } else if (command.is("receive_lossless")) {
            receive(sink.lossless, count);
        } else if (command.is("newest")) {
            say(sink.newest.recv().value());
        } else if (command.is("latest")) {
            auto newest = sink.newest.latest();
            say(newest ? std::to_string(newest->value()) : "none");
        } else if (command.is("pull")) {
            receive(sink.jobs, count);
        } else if (command.is("serve")) {
            for (auto& request : sink.answer) {
                request.reply(message(request->value() * 2));
                say("served");
                if (--count == 0) {
                    break;
                }
            }
        } else if (command.is("take_request")) {
            unanswered.push_back(sink.answer.recv());
            say("taken");
        } else if (command.is("answer_taken")) {
            for (auto& request : unanswered) {
                answer([&] { return request.reply(message(request->value() * 2)), "answered"; });
            }
            unanswered.clear();
        } else if (command.is("wait")) {
            // Everything that the test has sent arrives, at whichever gates.
            std::uint64_t readings = 0, jobs = 0;
            while (readings < count || jobs < count) {
                auto ready = scl::wait(std::chrono::seconds(60), sink.readings, sink.jobs);
                while (ready[0] && sink.readings.try_recv()) {
                    ++readings;
                }
                while (ready[1] && sink.jobs.try_recv()) {
                    ++jobs;
                }
            }
            say(readings, " ", jobs);
        } else {
            say("unknown command");
        }
    }
    return 0;
}

int main(int, char** arguments) { return std::string(arguments[1]) == "source" ? play_source() : play_sink(); }
