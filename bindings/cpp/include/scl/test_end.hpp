/// The two components of a unit test, before they have their types.
#pragma once

#include <scl.h>

#include <utility>

namespace scl {

/// An open component of a unit test, from which a component of its type is made.
class TestEnd {
  public:
    TestEnd() = default;
    TestEnd(TestEnd&& other) noexcept : handle_(other.release()) {}
    TestEnd& operator=(TestEnd&&) = delete;

    ~TestEnd() {
        if (handle_ != nullptr) {
            scl_close(handle_, 0);
        }
    }

    /// Where the C interface stores the component.
    scl_component** result() noexcept { return &handle_; }

    scl_component* release() noexcept { return std::exchange(handle_, nullptr); }

  private:
    scl_component* handle_ = nullptr;
};

} // namespace scl
