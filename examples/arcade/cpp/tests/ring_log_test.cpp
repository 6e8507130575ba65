// The two files of the log: what they contain, after restarts, when they are full, and when they cannot be written.
#include "check.hpp"
#include "ring_log.hpp"

#include <csignal>
#include <fstream>
#include <sstream>
#include <sys/resource.h>
#include <unistd.h>

namespace fs = std::filesystem;

static fs::path fresh_folder() {
    char name[] = "/tmp/ring_log_test.XXXXXX";
    CHECK(mkdtemp(name) != nullptr);
    return name;
}

static std::string content(const fs::path& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
}

static void lines_are_written_when_flushed() {
    auto folder = fresh_folder();
    RingLog log(folder / "a" / "b", 4096);
    log.append("{\"x\":1}");
    CHECK(!fs::exists(log.file(0)));
    CHECK(!log.flush());
    CHECK(content(log.file(0)) == "{\"file\":1}\n{\"x\":1}\n");
    CHECK(log.written() == 1);
    fs::remove_all(folder);
}

static void a_full_file_makes_place_for_the_other_one() {
    auto folder = fresh_folder();
    RingLog log(folder, 100);
    for (int i = 0; i < 100; i++) {
        log.append("line " + std::to_string(100 + i));
    }
    CHECK(!log.flush());
    // 9 bytes each after 11 or 12 bytes of the first line, so 9 lines in a file: the last one is number 12, with one line.
    CHECK(content(log.file(1)) == "{\"file\":12}\nline 199\n");
    auto before = content(log.file(0));
    CHECK(before.size() <= 100);
    CHECK(before.substr(0, 21) == "{\"file\":11}\nline 190\n");
    CHECK(before.substr(before.size() - 9) == "line 198\n");
    CHECK(log.lost() == 0);
    fs::remove_all(folder);
}

static void a_restarted_log_goes_on_with_the_newest_file() {
    auto folder = fresh_folder();
    std::ofstream(folder / "0.jsonl") << "{\"file\":9}\nold\n";
    std::ofstream(folder / "1.jsonl") << "{\"file\":10}\nnew\nhalf a li";
    RingLog log(folder, 4096);
    log.append("next");
    CHECK(!log.flush());
    CHECK(content(log.file(0)) == "{\"file\":9}\nold\n");
    CHECK(content(log.file(1)) == "{\"file\":10}\nnew\nhalf a li\nnext\n");
    fs::remove_all(folder);
}

static void files_that_are_no_log_are_replaced() {
    auto folder = fresh_folder();
    std::ofstream(folder / "1.jsonl") << std::string(100, '\0');
    RingLog log(folder, 4096);
    log.append("x");
    CHECK(!log.flush());
    CHECK(content(log.file(0)) == "{\"file\":1}\nx\n");
    fs::remove_all(folder);
}

static void a_folder_that_cannot_be_made_is_reported_once_and_nothing_is_lost() {
    auto folder = fresh_folder();
    std::ofstream(folder / "blocked") << "a file";
    RingLog log(folder / "blocked", 4096);
    log.append("one");
    auto change = log.flush();
    CHECK(change && change->find("cannot write the log in `" + (folder / "blocked").string() + "`: ") == 0);
    log.append("two");
    CHECK(!log.flush());
    fs::remove(folder / "blocked");
    CHECK(log.flush() == "writing the log again; lost lines: 0");
    CHECK(content(log.file(0)) == "{\"file\":1}\none\ntwo\n");
    CHECK(!log.flush());
    fs::remove_all(folder);
}

/// The limit of the size of files has the effect of a full disk: a write succeeds in part, and then fails.
static void limit_file_size(rlim_t bytes) {
    rlimit limit{bytes, RLIM_INFINITY};
    CHECK(setrlimit(RLIMIT_FSIZE, &limit) == 0);
}

static void a_full_disk_leaves_no_half_lines() {
    auto folder = fresh_folder();
    std::signal(SIGXFSZ, SIG_IGN);
    RingLog log(folder, 4096);
    log.append("one");
    CHECK(!log.flush());
    limit_file_size(18);
    log.append("two");
    auto change = log.flush();
    CHECK(change && change->find("cannot write the log") == 0);
    CHECK(content(log.file(0)) == "{\"file\":1}\none\n");
    limit_file_size(RLIM_INFINITY);
    CHECK(log.flush() == "writing the log again; lost lines: 0");
    CHECK(content(log.file(0)) == "{\"file\":1}\none\ntwo\n");
    fs::remove_all(folder);
}

static void memory_is_limited_while_nothing_can_be_written() {
    auto folder = fresh_folder();
    std::ofstream(folder / "blocked") << "a file";
    RingLog log(folder / "blocked", 4 << 20);
    for (int i = 0; i < 2048; i++) {
        log.append(std::string(1023, 'x'));
    }
    CHECK(log.flush());
    CHECK(log.lost() == 1024);
    fs::remove(folder / "blocked");
    CHECK(log.flush() == "writing the log again; lost lines: 1024");
    CHECK(log.written() == 1024);
    // Each outage is reported with its own losses.
    fs::remove_all(folder);
    std::ofstream(folder) << "in the way";
    log.append("one");
    CHECK(log.flush());
    fs::remove(folder);
    CHECK(log.flush() == "writing the log again; lost lines: 0");
    fs::remove_all(folder);
}

static void a_line_that_fits_no_file_is_dropped() {
    auto folder = fresh_folder();
    RingLog log(folder, 100);
    log.append(std::string(200, 'x'));
    log.append("next");
    CHECK(!log.flush());
    CHECK(log.lost() == 1);
    CHECK(log.written() == 1);
    fs::remove_all(folder);
}

static void deleted_files_are_made_again() {
    auto folder = fresh_folder() / "log";
    RingLog log(folder, 4096);
    log.append("one");
    CHECK(!log.flush());
    fs::remove_all(folder);
    log.append("two");
    CHECK(!log.flush());
    CHECK(content(log.file(0)) == "{\"file\":1}\ntwo\n");
    fs::remove_all(folder.parent_path());
}

int main() {
    lines_are_written_when_flushed();
    a_full_file_makes_place_for_the_other_one();
    a_restarted_log_goes_on_with_the_newest_file();
    files_that_are_no_log_are_replaced();
    a_folder_that_cannot_be_made_is_reported_once_and_nothing_is_lost();
    a_full_disk_leaves_no_half_lines();
    memory_is_limited_while_nothing_can_be_written();
    a_line_that_fits_no_file_is_dropped();
    deleted_files_are_made_again();
}
