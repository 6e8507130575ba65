/// Checks of single promises, by name: `checks NAME`, or all of them without a name. Both components of `checks.yaml`
/// are opened in this process, each on its own sockets.

#include "default.scl.hpp"
#include "support.hpp"

#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdlib>
#include <future>
#include <map>
#include <thread>

using checks::Number;
using checks::Text;
using default_::Left;
using default_::Right;
using namespace std::chrono_literals;

#define CHECK(condition)                                                                                               \
    do {                                                                                                               \
        if (!(condition)) {                                                                                            \
            std::cerr << __FILE__ << ":" << __LINE__ << ": not true: " #condition "\n";                              \
            std::exit(1);                                                                                              \
        }                                                                                                              \
    } while (false)

/// The error that a call throws; the test fails if it throws no such.
template <class Expected = scl::Error, class Call> static Expected thrown(Call&& call) {
    try {
        call();
    } catch (const Expected& error) {
        return error;
    }
    std::cerr << "nothing was thrown\n";
    std::exit(1);
}

static bool contains(std::string_view text, std::initializer_list<std::string_view> words) {
    for (auto word : words) {
        if (text.find(word) == text.npos) {
            std::cerr << "`" << word << "` is not in: " << text << "\n";
            return false;
        }
    }
    return true;
}

static Number number(std::uint64_t value) {
    Number number;
    number.set_value(value);
    return number;
}

/// Both components, connected.
struct Both {
    Left left;
    Right right;
    Both() {
        left.ready(300s);
        right.ready(300s);
    }
};

static void a_component_runs_once() {
    Left left;
    auto error = thrown<scl::Taken>([] { Left second; });
    CHECK(contains(error.what(), {"component `left`", "already running"}));
    CHECK(error.code() == scl::Errc::taken);
}

static void a_moved_component_goes_on() {
    Both both;
    Left moved = std::move(both.left);
    moved.numbers.send(number(1));
    CHECK(both.right.numbers.recv().value() == 1);
    CHECK(moved.name() == "left" && moved.numbers.name() == "left.numbers");
    auto error = thrown([&] { both.left.numbers.send(number(2)); });
    CHECK(contains(error.what(), {"moved"}));
    both.left = std::move(moved);
    both.left.numbers.send(number(3));
    CHECK(both.right.numbers.recv().value() == 3);
    // A component that is assigned to is closed first.
    both.left = Left(scl::Options{std::nullopt, "other", std::nullopt, true});
    Left again;
}

static void a_gate_moves_to_another_thread() {
    Both both;
    auto numbers = std::move(both.left.numbers);
    std::thread([numbers = std::move(numbers)]() mutable { numbers.send(number(1)); }).join();
    CHECK(both.right.numbers.recv().value() == 1);
}

static void a_closed_component_is_closed() {
    Left left;
    scl::Error error = thrown([&] {
        left.close();
        left.numbers.send(number(1));
    });
    CHECK(error.code() == scl::Errc::handle && contains(error.what(), {"gate `left.numbers` is closed"}));
    left.close();
    CHECK(contains(thrown([&] { left.fd(); }).what(), {"component `left` is closed"}));
    CHECK(contains(thrown([&] { left.ready(0s); }).what(), {"component `left` is closed"}));
    CHECK(!left.numbers.is_connected());
    Left again;
}

static void every_call_after_closing_names_its_gate() {
    Both both;
    both.left.close();
    both.right.close();
    auto names = [](const char* gate, auto&& call) {
        auto error = thrown(call);
        CHECK(error.code() == scl::Errc::handle && contains(error.what(), {gate}));
    };
    names("`left.numbers`", [&] { (void)both.left.numbers.try_send(number(1)); });
    names("`left.numbers`", [&] { both.left.numbers.stats(); });
    names("`left.ask`", [&] { both.left.ask.call(number(1)); });
    names("`right.numbers`", [&] { both.right.numbers.recv(); });
    names("`right.numbers`", [&] { both.right.numbers.latest(); });
    names("`right.answer`", [&] { both.right.answer.try_recv(); });
    names("`right.jobs`", [&] { scl::wait(1h, both.right.jobs, both.right.numbers); });
    std::error_code error;
    CHECK(!both.right.jobs.recv(error) && error == scl::Errc::handle && contains(scl::last_error(), {"`right.jobs`"}));
}

static void a_loop_ends_when_its_component_is_closed() {
    Both both;
    both.left.numbers.send(number(1));
    int received = 0;
    // In the body of the loop, and while it waits.
    for (auto& message : both.right.numbers) {
        received += static_cast<int>(message.value());
        both.right.close();
    }
    CHECK(received == 1);
    for (auto& message : both.right.jobs) {
        (void)message;
        ++received;
    }
    CHECK(received == 1);
    Right right;
    std::promise<void> waiting;
    auto ended = std::async(std::launch::async, [&] {
        waiting.set_value();
        for (auto& request : right.answer) {
            request.reply(Text());
        }
    });
    waiting.get_future().wait();
    right.close();
    ended.get();
}

static void errors_compare_to_those_of_the_system() {
    const std::pair<scl::Errc, std::errc> same[] = {
        {scl::Errc::timeout, std::errc::timed_out},
        {scl::Errc::full, std::errc::resource_unavailable_try_again},
        {scl::Errc::stopped, std::errc::interrupted},
        {scl::Errc::peer_lost, std::errc::connection_reset},
        {scl::Errc::requester_gone, std::errc::broken_pipe},
        {scl::Errc::busy, std::errc::device_or_resource_busy},
        {scl::Errc::too_long, std::errc::message_size},
        {scl::Errc::decode, std::errc::bad_message},
        {scl::Errc::encode, std::errc::invalid_argument},
        {scl::Errc::argument, std::errc::invalid_argument},
        {scl::Errc::handle, std::errc::bad_file_descriptor},
        {scl::Errc::kind, std::errc::operation_not_supported},
        {scl::Errc::taken, std::errc::address_in_use},
        {scl::Errc::closed, std::errc::operation_canceled},
        {scl::Errc::forked, std::errc::operation_not_permitted},
    };
    for (auto [own, system] : same) {
        std::error_code code = own;
        CHECK(code == own && code == system && own == system);
        CHECK(code != std::errc::io_error && code != scl::Errc::failed);
    }
    CHECK(std::error_code(scl::Errc::not_flushed) != std::errc::timed_out);
}

static void texts_of_errors_outlive_later_ones() {
    Left left;
    std::error_code error;
    const char* first = (left.ready(1ns, error), scl::last_error());
    std::string copy = first;
    for (int count = 0; count < 15; ++count) {
        CHECK(thrown([&] { scl::Pub<Number>(left, "number"); }).code() == scl::Errc::name);
    }
    CHECK(first == copy && first != scl::last_error());
}

static void closing_tells_what_was_not_taken() {
    Both both;
    for (std::uint64_t value = 0; value < 20; ++value) {
        std::error_code error;
        both.left.jobs.send(number(value), 1ms, error);
    }
    auto error = thrown<scl::NotFlushed>([&] { both.left.close(1ms); });
    CHECK(contains(error.what(), {"right.jobs"}));
}

static void a_gate_serves_one_thread_at_a_time() {
    Left left;
    Right right;
    std::atomic<int> busy = 0;
    // One of the two waits, so the other one is refused.
    auto receive = [&] {
        std::error_code error;
        right.numbers.recv(1h, error);
        if (error == scl::Errc::busy) {
            ++busy;
            left.numbers.send(number(1));
        }
    };
    std::thread first(receive), second(receive);
    first.join();
    second.join();
    CHECK(busy == 1);
    CHECK(contains(scl::Error(scl::Errc::busy, "").code().message(), {"another thread"}));
}

static void two_threads_send_over_one_gate_or_are_refused() {
    Both both;
    std::atomic<std::uint64_t> sent = 0;
    auto send = [&] {
        for (int count = 0; count < 1000; ++count) {
            std::error_code error;
            sent += both.left.numbers.send(number(7), error);
            CHECK(!error || error == scl::Errc::busy);
        }
    };
    std::thread first(send), second(send);
    first.join();
    second.join();
    both.left.numbers.send(number(8));
    std::uint64_t received = 0;
    while (both.right.numbers.recv().value() == 7) {
        ++received;
    }
    // The queue drops the oldest.
    CHECK(received > 0 && received <= sent);
}

static void every_gate_has_a_thread_of_its_own() {
    constexpr std::uint64_t count = 300;
    Both both;
    std::thread publish([&] {
        for (std::uint64_t value = 0; value < count; ++value) {
            both.left.numbers.send(number(value));
        }
    });
    std::thread subscribe([&] {
        for (std::uint64_t value = 0; value < count; ++value) {
            CHECK(both.right.numbers.recv().value() == value);
        }
    });
    std::thread push([&] {
        for (std::uint64_t value = 0; value < count; ++value) {
            both.left.jobs.send(number(value));
        }
    });
    std::thread pull([&] {
        for (std::uint64_t value = 0; value < count; ++value) {
            CHECK(both.right.jobs.recv().value() == value);
        }
    });
    std::thread serve([&] {
        std::uint64_t answered = 0;
        for (auto& request : both.right.answer) {
            Text text;
            text.set_text(std::to_string(request->value()));
            request.reply(text);
            if (++answered == count) {
                break;
            }
        }
    });
    for (std::uint64_t value = 0; value < count; ++value) {
        CHECK(both.left.ask.call(number(value)).text() == std::to_string(value));
    }
    for (auto* thread : {&publish, &subscribe, &push, &pull, &serve}) {
        thread->join();
    }
}

static void closing_ends_calls_of_other_threads() {
    Right right;
    std::promise<void> waiting;
    auto ended = std::async(std::launch::async, [&] {
        waiting.set_value();
        return thrown([&] { right.numbers.recv(); }).code();
    });
    waiting.get_future().wait();
    right.close();
    auto code = ended.get();
    CHECK(code == scl::Errc::closed || code == scl::Errc::handle);
}

// AddressSanitizer of GCC 12 does not protect the locks of its allocator when a process forks, so a child hangs in `malloc` if
// another thread of the parent was in there.
#ifndef __SANITIZE_ADDRESS__
static void a_forked_child_is_refused() {
    Both both;
    pid_t child = ::fork();
    if (child == 0) {
        std::error_code error;
        both.left.numbers.send(number(1), error);
        bool refused = error == scl::Errc::forked;
        both.right.close(0s, error);
        ::_exit(refused && error == scl::Errc::forked ? 0 : 1);
    }
    int status = 0;
    CHECK(::waitpid(child, &status, 0) == child && status == 0);
    both.left.numbers.send(number(2));
    CHECK(both.right.numbers.recv().value() == 2);
}
#endif

static void nothing_in_time_is_no_error() {
    Right right;
    CHECK(!right.numbers.recv(1ms) && !right.numbers.try_recv() && !right.numbers.latest());
    CHECK(!right.jobs.recv(-5s) && !right.answer.recv(1us) && !right.answer.try_recv());
    std::error_code error = scl::Errc::panic;
    CHECK(!right.numbers.recv(1ms, error) && !error);
    error = scl::Errc::panic;
    CHECK(!right.answer.try_recv(error) && !error);
    CHECK(scl::wait(1ms, right.numbers, right.answer).none());
}

static void a_missing_peer_is_a_timeout() {
    Left left;
    auto not_ready = thrown<scl::Timeout>([&] { left.ready(1ms); });
    CHECK(contains(not_ready.what(), {"component `left`", "`right.numbers`"}));
    auto no_reply = thrown<scl::Timeout>([&] { left.ask.call(number(1), 1ms); });
    CHECK(contains(no_reply.what(), {"`left.ask`", "`right.answer`"}));
    std::error_code error;
    CHECK(!left.ask.call(number(1), 1ms, error) && error == scl::Errc::timeout);
    CHECK(contains(scl::last_error(), {"`left.ask`"}));
    CHECK(!left.ready(0s, error) && error == scl::Errc::timeout);
}

static void a_full_queue_is_told() {
    Both both;
    auto full = thrown<scl::Full>([&] {
        // The messages on their way have room, too.
        while (true) {
            both.left.jobs.send(number(1), 100ms);
        }
    });
    CHECK(contains(full.what(), {"`left.jobs`", "full"}));
    CHECK(!both.left.jobs.try_send(number(1)));
    std::error_code error;
    CHECK(!both.left.jobs.send(number(1), 1ms, error) && error == scl::Errc::full);
    while (both.right.jobs.recv(100ms)) {
    }
    both.left.jobs.send(number(1));
}

static void undecodable_messages_are_told_and_skipped() {
    Both both;
    scl::Pub<scl::Bytes> raw(both.left, "numbers");
    raw.send("\xff\xff");
    auto error = thrown<scl::DecodeError>([&] { both.right.numbers.recv(); });
    CHECK(contains(error.what(), {"`right.numbers`", "2 bytes", "`checks.Number`"}));
    raw.send("\xff\xff");
    both.left.numbers.send(number(5));
    std::error_code code;
    CHECK(!both.right.numbers.recv(code) && code == scl::Errc::decode);
    CHECK(contains(scl::last_error(), {"`right.numbers`", "undecodable"}));
    CHECK(both.right.numbers.recv(code)->value() == 5 && !code);
    CHECK(contains(both.right.numbers.stats(), {R"("rejected":2,)"}));

    scl::Pub<scl::Bytes> text(both.left, "text");
    text.send("{\"text\": 5");
    auto json = thrown<scl::DecodeError>([&] { both.right.text.recv(); });
    CHECK(contains(json.what(), {"`right.text`", "`checks.Text`"}));
}

static void json_is_canonical() {
    Both both;
    scl::Sub<std::string> text(both.right, "text");
    Text message;
    message.set_text("ü");
    message.set_long_number(1);
    both.left.text.send(message);
    CHECK(text.recv() == R"({"text":"ü","longNumber":"1"})");
    scl::Pub<std::string> raw(both.left, "text");
    raw.send(R"({"long_number": 7, "added": {"later": [1]}})");
    CHECK(both.right.text.recv().long_number() == 7);
    both.left.rust_json.send(R"({"lat":1.5})");
    CHECK(both.right.rust_json.recv() == R"({"lat":1.5})");
}

static void bytes_are_taken_from_anything() {
    Both both;
    auto echo = [&](scl::BytesView bytes) {
        both.left.delete_.send(bytes);
        return both.right.class_.recv().to_string();
    };
    const unsigned char array[] = {1, 2};
    CHECK(echo("text") == "text");
    CHECK(echo(std::string("a\0b", 3)) == std::string("a\0b", 3));
    CHECK(echo(std::string_view("view")) == "view");
    CHECK(echo(std::vector<std::byte>{std::byte{65}}) == "A");
    CHECK(echo(std::array<char, 2>{'h', 'i'}) == "hi");
    CHECK(echo(array) == "\1\2");
    CHECK(echo({array, 1}) == "\1");
    CHECK(echo("").empty() && echo({}).empty() && echo(std::vector<unsigned char>()).empty());
    CHECK(echo(std::string(100'000, 'x')).size() == 100'000);

    both.left.delete_.send("moved");
    scl::Bytes first = both.right.class_.recv();
    scl::Bytes second = std::move(first);
    first = std::move(second);
    first = scl::Bytes(std::move(first));
    CHECK(first.text() == "moved" && second.empty() && first[0] == 'm' && first.to_vector().size() == 5);
    for (unsigned char byte : first) {
        CHECK(byte >= 'a');
    }
    both.left.delete_.send(first);
    CHECK(both.right.class_.latest().has_value() || both.right.class_.recv().to_string() == "moved");

    std::string memory = "borrowed";
    scl::Bytes borrowed = scl::Bytes::borrowed(memory.data(), memory.size());
    scl::Bytes kept = std::move(borrowed);
    memory = "replaced";
    CHECK(kept.text() == "borrowed" && borrowed.empty());

    std::thread serve([&] {
        for (auto& request : both.right.answer_bytes) {
            request.reply(*request);
            // The message stays when the request is gone.
            CHECK(request->text() == "echo" && request.message().size() == 4);
            break;
        }
    });
    CHECK(both.left.ask_bytes.call("echo").to_string() == "echo");
    serve.join();
}

struct Position {
    double lat, lon;
};

/// A type of a program, with a codec of its own.
struct Word {
    std::string letters;
};

template <> struct scl::Codec<Word> {
    static BytesView encode(const Word& word, std::string& buffer) {
        if (word.letters.empty()) {
            throw std::invalid_argument("a word has letters");
        }
        buffer = word.letters + ".";
        return buffer;
    }

    static Word decode(Bytes bytes) {
        if (bytes.empty() || bytes.text().back() != '.') {
            throw std::invalid_argument("a word ends with a full stop");
        }
        return {std::string(bytes.text().substr(0, bytes.size() - 1))};
    }
};

static void types_of_the_program_have_codecs() {
    Both both;
    scl::Pub<Position, scl::Raw> structs(std::move(both.left.structs));
    scl::Sub<Position, scl::Raw> structs_in(std::move(both.right.structs));
    structs.send({52.5, 13.4});
    CHECK(structs_in.recv().lon == 13.4);
    scl::Pub<scl::Bytes>(both.left, "structs").send("short");
    auto wrong_length = thrown<scl::DecodeError>([&] { structs_in.recv(); });
    CHECK(contains(wrong_length.what(), {"exactly 16 bytes", "received 5"}));

    scl::Req<Word, Word> ask(std::move(both.left.ask_bytes));
    scl::Rep<Word, Word> answer(std::move(both.right.answer_bytes));
    std::thread serve([&] {
        auto request = answer.recv();
        // A reply that cannot be encoded leaves the request open.
        auto error = thrown<scl::EncodeError>([&] { request.reply({}); });
        CHECK(contains(error.what(), {"`right.answer_bytes`", "a word has letters"}));
        request.reply({request->letters + "!"});
        CHECK(thrown([&] { request.reply({"again"}); }).code() == scl::Errc::handle);
    });
    CHECK(ask.call({"hello"}).letters == "hello!");
    serve.join();
    std::error_code error;
    CHECK(!ask.call(Word{}, error) && error == scl::Errc::encode);
    CHECK(contains(scl::last_error(), {"`left.ask_bytes`", "a word has letters"}));
}

static void a_message_that_is_too_long_is_refused() {
    Both both;
    Number long_one = number(1);
    long_one.set_padding(std::string(2000, 'x'));
    auto error = thrown<scl::TooLong>([&] { both.left.numbers.send(long_one); });
    CHECK(contains(error.what(), {"`left.numbers`", "`right.numbers`", "1024", "max_size"}));
    both.left.numbers.send(number(2));
    CHECK(both.right.numbers.recv().value() == 2);
}

static void an_exception_of_the_program_loses_no_request_in_silence() {
    Both both;
    auto call = std::async(std::launch::async, [&] {
        std::error_code error;
        both.left.ask.call(number(1), 1s, error);
        return error;
    });
    auto error = thrown<std::out_of_range>([&] {
        for (auto& request : both.right.answer) {
            throw std::out_of_range(std::to_string(request->value()));
        }
    });
    CHECK(error.what() == std::string("1"));
    CHECK(call.get() == scl::Errc::timeout);
    // Both gates still work.
    call = std::async(std::launch::async, [&] {
        std::error_code error;
        both.left.ask.call(number(2), error);
        return error;
    });
    auto request = both.right.answer.recv();
    while (request->value() != 2) {
        request = both.right.answer.recv();
    }
    request.reply(Text());
    CHECK(!call.get());
}

static void several_gates_are_awaited_together() {
    Both both;
    both.left.numbers.send(number(1));
    auto ready = scl::wait(both.right.jobs, both.right.numbers, both.right.answer);
    CHECK(ready == scl::wait(300s, both.right.jobs, both.right.numbers, both.right.answer));
    CHECK(ready.to_ulong() == 2);
    CHECK(both.right.numbers.try_recv()->value() == 1);
    std::error_code error;
    ready = scl::wait(0s, error, both.right.jobs, both.right.numbers, both.right.answer);
    CHECK(ready.none() && !error);
    both.left.jobs.send(number(2));
    pollfd readable{both.right.fd(), POLLIN, 0};
    CHECK(both.right.fd() == readable.fd);
    CHECK(::poll(&readable, 1, 60'000) == 1 && both.right.jobs.try_recv()->value() == 2);
    CHECK(thrown([&] { scl::wait(0s, both.right.numbers, both.right.numbers); }).code() == scl::Errc::busy);
}

static void counts_are_json() {
    Both both;
    both.left.numbers.send(number(1));
    CHECK(contains(both.left.numbers.stats(), {R"("sent":1,)", R"("peer":"right.numbers")"}));
    CHECK(both.left.numbers.is_connected());
}

static void wrong_plans_and_names_are_refused() {
    CHECK(thrown([] { scl::Component component("{}", "left"); }).code() == scl::Errc::plan);
    auto error = thrown([] { scl::Component component(default_::scl_generated::plan, "lift"); });
    CHECK(error.code() == scl::Errc::name && contains(error.what(), {"`lift`", "did you mean `left`?"}));
    Left left;
    auto gate = thrown([&] { scl::Pub<Number>(left, "number"); });
    CHECK(gate.code() == scl::Errc::name && contains(gate.what(), {"`number`", "did you mean `numbers`?"}));
    auto kind = thrown([&] { scl::Sub<Number>(left, "numbers").recv(); });
    CHECK(kind.code() == scl::Errc::kind);
}

static void options_replace_the_environment() {
    scl::Options options;
    options.transport = "udp";
    CHECK(thrown([&] { Left left(options); }).code() == scl::Errc::argument);
    options.transport = "tcp";
    options.system = "other";
    Left first, second(options);
    options.runtime_dir = "a\"b\\c\nd";
    CHECK(options.to_json() ==
          R"({"signals":true,"runtime_dir":"a\"b\\c\u000ad","system":"other","transport":"tcp"})");
}

static_assert(scl::TimeLimit(1s).nanoseconds() == 1'000'000'000);
static_assert(scl::TimeLimit(0s).nanoseconds() == 0 && scl::TimeLimit(-1s).nanoseconds() == 0);
static_assert(scl::TimeLimit(std::chrono::duration<double, std::pico>(1)).nanoseconds() == 1);
static_assert(scl::TimeLimit(std::chrono::duration<double>(0.5)).nanoseconds() == 500'000'000);
static_assert(scl::TimeLimit(std::chrono::hours::max()).nanoseconds() == -1);
static_assert(scl::TimeLimit::none().nanoseconds() == -1);
static_assert(std::is_nothrow_move_constructible_v<scl::Pub<Number>>);
static_assert(!std::is_copy_constructible_v<scl::Pub<Number>>);
static_assert(std::is_move_assignable_v<Left> && !std::is_copy_constructible_v<Left>);
static_assert(std::is_move_constructible_v<scl::Request<Number, Text>>);
static_assert(!std::is_convertible_v<std::string, scl::Bytes> && !std::is_convertible_v<int, scl::BytesView>);

int main(int count, char** arguments) {
    const std::map<std::string, void (*)()> checks = {
#define NAMED(check) {#check, check}
        NAMED(a_component_runs_once),
        NAMED(a_moved_component_goes_on),
        NAMED(a_gate_moves_to_another_thread),
        NAMED(a_closed_component_is_closed),
        NAMED(every_call_after_closing_names_its_gate),
        NAMED(a_loop_ends_when_its_component_is_closed),
        NAMED(errors_compare_to_those_of_the_system),
        NAMED(texts_of_errors_outlive_later_ones),
        NAMED(closing_tells_what_was_not_taken),
        NAMED(a_gate_serves_one_thread_at_a_time),
        NAMED(two_threads_send_over_one_gate_or_are_refused),
        NAMED(every_gate_has_a_thread_of_its_own),
        NAMED(closing_ends_calls_of_other_threads),
#ifndef __SANITIZE_ADDRESS__
        NAMED(a_forked_child_is_refused),
#endif
        NAMED(nothing_in_time_is_no_error),
        NAMED(a_missing_peer_is_a_timeout),
        NAMED(a_full_queue_is_told),
        NAMED(undecodable_messages_are_told_and_skipped),
        NAMED(json_is_canonical),
        NAMED(bytes_are_taken_from_anything),
        NAMED(types_of_the_program_have_codecs),
        NAMED(a_message_that_is_too_long_is_refused),
        NAMED(an_exception_of_the_program_loses_no_request_in_silence),
        NAMED(several_gates_are_awaited_together),
        NAMED(counts_are_json),
        NAMED(wrong_plans_and_names_are_refused),
        NAMED(options_replace_the_environment),
    };
    for (const auto& [name, check] : checks) {
        if (count < 2 || name == arguments[1]) {
            check();
            support::say(name);
        }
    }
}
