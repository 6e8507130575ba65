/// The components that are open, and what closes them when an exception of SCL is not caught.
#pragma once

#include <scl.h>
#include <scl/error.hpp>
#include <scl/log.hpp>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <mutex>
#include <vector>

#include <unistd.h>

namespace scl::detail {

/// Time for peers to take what was sent when a component is destroyed, in nanoseconds. As in Rust programs.
inline constexpr std::int64_t linger = 1'000'000'000;

class OpenComponents {
  public:
    /// Never destroyed, because components may be static objects.
    static OpenComponents& instance() {
        static auto* components = new OpenComponents;
        return *components;
    }

    void add(scl_component* component) {
        std::lock_guard<std::mutex> lock(mutex_);
        components_.push_back(component);
    }

    void remove(scl_component* component) noexcept {
        std::lock_guard<std::mutex> lock(mutex_);
        components_.erase(std::remove(components_.begin(), components_.end(), component), components_.end());
    }

    /// Calls of other threads to their gates end with an error.
    void close_all() noexcept {
        std::vector<scl_component*> components;
        {
            std::lock_guard<std::mutex> lock(mutex_);
            components.swap(components_);
        }
        for (scl_component* component : components) {
            if (scl_close(component, linger) == SCL_NOT_FLUSHED) {
                log_warning(scl_error());
            }
        }
    }

  private:
    std::mutex mutex_;
    std::vector<scl_component*> components_;
};

/// Ends the program as an error that a Rust program returns from `main`: after a stop request with exit code 0, else
/// with a message and exit code 1, and only when the messages that were sent are flushed.
class UncaughtErrors {
  public:
    static void handle() {
        static UncaughtErrors installed;
    }

  private:
    UncaughtErrors() : previous_(std::set_terminate(terminate)) { before() = previous_; }

    static std::terminate_handler& before() noexcept {
        static std::terminate_handler handler = nullptr;
        return handler;
    }

    static void terminate() {
        if (std::current_exception() != nullptr) {
            try {
                throw;
            } catch (const Stopped&) {
                end(EXIT_SUCCESS);
            } catch (const Error& error) {
                std::fprintf(stderr, "error: %s\n", error.what());
                end(EXIT_FAILURE);
            } catch (...) {
                // Not ours.
            }
        }
        if (before() != nullptr) {
            before()();
        }
        std::abort();
    }

    [[noreturn]] static void end(int code) {
        static std::atomic_flag ending = ATOMIC_FLAG_INIT;
        while (ending.test_and_set()) {
            // Another thread already ends the program, which only one may do.
            ::pause();
        }
        OpenComponents::instance().close_all();
        std::exit(code);
    }

    std::terminate_handler previous_;
};

} // namespace scl::detail
