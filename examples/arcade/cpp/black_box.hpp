/// What the black box makes of the messages that it receives: lines of its log.
#pragma once

#include "arcade.scl.hpp"
#include "beat_statistics.hpp"
#include "ring_log.hpp"

class BlackBox {
  public:
    explicit BlackBox(RingLog& log) : log_(log) {}

    /// Takes every message that waits at a gate.
    void drain(arcade::Blackbox& component);
    /// Logs the beats since the last call and flushes the log; to be called once a second.
    void flush();
    /// The beats since the start.
    const BeatStatistics& beats() const { return total_; }
    /// One line about everything since the start.
    std::string summary() const;

  private:
    RingLog& log_;
    BeatStatistics second_, total_;
};
