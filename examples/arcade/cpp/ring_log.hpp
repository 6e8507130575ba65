/// A log of lines in two files of limited size. When one is full, the other one is begun anew, so that at least one file's
/// size of the newest lines is kept, and the disk never fills up.
#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <optional>
#include <string>

class RingLog {
  public:
    /// `size` is the limit of each file in bytes. Nothing is opened before the first flush.
    RingLog(std::filesystem::path folder, std::uint64_t size) : folder_(std::move(folder)), size_(size) {}
    ~RingLog() { close(); }
    RingLog(const RingLog&) = delete;
    RingLog& operator=(const RingLog&) = delete;

    /// Keeps a line in memory until the next flush. When the files cannot be written for long, the oldest ones are dropped.
    void append(std::string line);
    /// Hands all lines to the operating system. Returns what has changed: that it does not work, or works again.
    std::optional<std::string> flush();

    std::size_t waiting() const { return lines_.size(); }
    std::uint64_t written() const { return written_; } // lines
    std::uint64_t lost() const { return lost_; }       // lines
    std::filesystem::path file(unsigned which) const { return folder_ / (which == 0 ? "0.jsonl" : "1.jsonl"); }

  private:
    /// All of these return false if the system refuses, with the reason in `errno`.
    bool write_lines();
    bool open_newest();
    bool begin(unsigned which, std::uint64_t number);
    bool write_all(const std::string& text);
    void close();
    bool is_deleted() const;

    std::filesystem::path folder_;
    std::uint64_t size_;
    std::deque<std::string> lines_;
    std::size_t bytes_ = 0; // of `lines_`
    std::uint64_t written_ = 0, lost_ = 0, lost_before_ = 0;
    bool works_ = true;

    int descriptor_ = -1;
    unsigned which_ = 0;        // of the two files
    std::uint64_t number_ = 0;  // of the file since the first one; its first line tells it
    std::uint64_t length_ = 0;  // of the file
};
