/// Bytes: a view of what is sent, and received messages as owned bytes.
#pragma once

#include <scl.h>

#include <cstddef>
#include <cstring>
#include <iterator>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace scl {

namespace detail {

template <class T>
inline constexpr bool is_byte = std::is_same_v<T, char> || std::is_same_v<T, signed char> ||
                                std::is_same_v<T, unsigned char> || std::is_same_v<T, std::byte>;

template <class T, class = void> inline constexpr bool is_byte_container = false;

template <class T>
inline constexpr bool is_byte_container<
    T, std::void_t<decltype(std::data(std::declval<const T&>())), decltype(std::size(std::declval<const T&>()))>> =
    is_byte<std::remove_cv_t<std::remove_pointer_t<decltype(std::data(std::declval<const T&>()))>>>;

} // namespace detail

/// Borrowed bytes, for the duration of a call: made from strings, string views, and any container or array of `char`,
/// `unsigned char` or `std::byte`.
class BytesView {
  public:
    constexpr BytesView() noexcept = default;
    constexpr BytesView(const void* data, std::size_t size) noexcept : data_(data), size_(size) {}
    constexpr BytesView(std::string_view text) noexcept : data_(text.data()), size_(text.size()) {}
    /// The text up to its final zero, which is not part of the message.
    constexpr BytesView(const char* text) noexcept : BytesView(std::string_view(text)) {}

    template <class Container, std::enable_if_t<detail::is_byte_container<Container>, int> = 0>
    constexpr BytesView(const Container& bytes) noexcept : data_(std::data(bytes)), size_(std::size(bytes)) {}

    constexpr const void* data() const noexcept { return data_; }
    constexpr std::size_t size() const noexcept { return size_; }
    constexpr bool empty() const noexcept { return size_ == 0; }

  private:
    const void* data_ = nullptr;
    std::size_t size_ = 0;
};

/// A received message as bytes. It owns the bytes that the library received, without a copy.
class Bytes {
  public:
    Bytes() noexcept = default;

    /// Takes over a message of the C interface.
    explicit Bytes(scl_message* message) noexcept : message_(message) {
        data_ = static_cast<const unsigned char*>(scl_message_data(message_, &size_));
    }

    /// The bytes of a request, borrowed from it. Moving them makes a copy, so that they can be kept.
    static Bytes borrowed(const void* data, std::size_t size) noexcept {
        return Bytes(static_cast<const unsigned char*>(data), size);
    }

    Bytes(Bytes&& other) : size_(other.size_) {
        if (other.message_ == nullptr && other.copy_ == nullptr && size_ != 0) {
            copy_ = std::make_unique<unsigned char[]>(size_);
            std::memcpy(copy_.get(), other.data_, size_);
            data_ = copy_.get();
        } else {
            data_ = std::exchange(other.data_, nullptr);
            copy_ = std::move(other.copy_);
            message_ = std::exchange(other.message_, nullptr);
        }
        other.size_ = 0;
    }

    Bytes& operator=(Bytes&& other) {
        Bytes moved(std::move(other));
        std::swap(message_, moved.message_);
        std::swap(copy_, moved.copy_);
        std::swap(data_, moved.data_);
        std::swap(size_, moved.size_);
        return *this;
    }

    ~Bytes() {
        if (message_ != nullptr) {
            scl_message_free(message_);
        }
    }

    const unsigned char* data() const noexcept { return data_; }
    std::size_t size() const noexcept { return size_; }
    bool empty() const noexcept { return size_ == 0; }
    const unsigned char* begin() const noexcept { return data_; }
    const unsigned char* end() const noexcept { return data_ + size_; }
    unsigned char operator[](std::size_t index) const noexcept { return data_[index]; }

    /// The bytes as text, valid as long as this object.
    std::string_view text() const& noexcept { return {reinterpret_cast<const char*>(data_), size_}; }
    std::string_view text() const&& = delete;

    std::string to_string() const { return std::string(text()); }
    std::vector<unsigned char> to_vector() const { return {begin(), end()}; }

  private:
    Bytes(const unsigned char* data, std::size_t size) noexcept : data_(data), size_(size) {}

    scl_message* message_ = nullptr;
    std::unique_ptr<unsigned char[]> copy_;
    const unsigned char* data_ = nullptr;
    std::size_t size_ = 0;
};

} // namespace scl
