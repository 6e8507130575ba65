/// What happens to uncaught exceptions of SCL.
#pragma once

#include <scl/error.hpp>
#include <scl/open_components.hpp>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <exception>

#include <unistd.h>

namespace scl::detail {

/// Ends the program like an error that a Rust program returns from `main`: with exit code 0 after a stop request, else
/// with a message and exit code 1, and only after sent messages are flushed.
class UncaughtErrors {
  public:
    /// Installs the terminate handler, once.
    static void handle() {
        static const std::terminate_handler previous = std::set_terminate(terminate);
        before() = previous;
    }

  private:
    static std::atomic<std::terminate_handler>& before() noexcept {
        static std::atomic<std::terminate_handler> handler = nullptr;
        return handler;
    }

    [[noreturn]] static void terminate() {
        if (std::current_exception() != nullptr) {
            try {
                throw;
            } catch (const Stopped&) {
                end(EXIT_SUCCESS);
            } catch (const Error& error) {
                std::fprintf(stderr, "error: %s\n", error.what());
                end(EXIT_FAILURE);
            } catch (...) {
                // Not an exception of SCL.
            }
        }
        if (std::terminate_handler handler = before()) {
            handler();
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
};

} // namespace scl::detail
