#pragma once
/// \file
/// A contiguous array of values that costs a compiler little.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <new>
#include <stdexcept>
#include <type_traits>
#include <utility>

namespace polybody {
namespace detail {

/// Room for `count` values of `size` bytes each. Throws std::bad_alloc.
inline void* take_memory(std::size_t count, std::size_t size, std::size_t alignment) {
  if (count > std::size_t(PTRDIFF_MAX) / size) throw std::bad_alloc();
  return alignment > __STDCPP_DEFAULT_NEW_ALIGNMENT__ ? ::operator new(count * size, std::align_val_t(alignment))
                                                      : ::operator new(count * size);
}
inline void give_memory(void* memory, std::size_t alignment) noexcept {
  if (alignment > __STDCPP_DEFAULT_NEW_ALIGNMENT__)
    ::operator delete(memory, std::align_val_t(alignment));
  else
    ::operator delete(memory);
}

}  // namespace detail

/// Values one after the other in memory, with the usual members of std::vector and their meaning. A type of value costs
/// a compiler a third of what it does in std::vector (`bench/compile --containers`): the core's own arrays are
/// Sequences, what a user passes is a std::vector or a span.
template <class T>
class Sequence {
 public:
  using value_type = T;  ///< the type of its values, as std::vector names it

  Sequence() = default;
  explicit Sequence(std::size_t size) : Sequence() { resize(size); }                ///< `size` values T()
  Sequence(std::size_t size, T const& value) : Sequence() { assign(size, value); }  ///< `size` copies of `value`
  /// Copies of `values`.
  Sequence(std::initializer_list<T> values) : Sequence() { copy(values.begin(), values.size()); }
  /// Copies of the values of the range [first, last).
  template <class It>
    requires requires(It i) { *i; }
  Sequence(It first, It last) : Sequence() {
    append(first, last);
  }
  Sequence(Sequence const& other) : Sequence() { copy(other.data_, other.size_); }  ///< copies all values
  Sequence(Sequence&& other) noexcept { swap(other); }  ///< takes the memory of `other`, which is empty then
  /// Keeps its memory where that is large enough.
  Sequence& operator=(Sequence const& other) {
    if (this != &other) {
      clear();
      copy(other.data_, other.size_);
    }
    return *this;
  }
  /// Takes the memory of `other`, which is empty then.
  Sequence& operator=(Sequence&& other) noexcept {
    Sequence taken(std::move(other));
    swap(taken);
    return *this;
  }
  ~Sequence() {
    clear();
    detail::give_memory(data_, alignof(T));
  }

  /// Exchanges the memory of both; no value is moved.
  void swap(Sequence& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    std::swap(capacity_, other.capacity_);
  }

  T* data() { return data_; }                     ///< the values in memory; null as long as there was no room for any
  T const* data() const { return data_; }         ///< the same, to be read
  T* begin() { return data_; }                    ///< the first value
  T const* begin() const { return data_; }        ///< the first value, to be read
  T* end() { return data_ + size_; }              ///< behind the last value
  T const* end() const { return data_ + size_; }  ///< behind the last value
  std::size_t size() const { return size_; }      ///< how many values there are
  bool empty() const { return size_ == 0; }       ///< whether there are none
  T& operator[](std::size_t i) { return data_[i]; }  ///< value i; a place that does not exist is not noticed
  T const& operator[](std::size_t i) const { return data_[i]; }  ///< value i, to be read
  /// Value number `i`. \throws std::out_of_range
  T& at(std::size_t i) { return data_[within(i)]; }
  T const& at(std::size_t i) const { return data_[within(i)]; }  ///< value number `i`, to be read
  T& front() { return *data_; }                                  ///< the first value, of one or more
  T const& front() const { return *data_; }                      ///< the first value, to be read
  T& back() { return data_[size_ - 1]; }                         ///< the last value, of one or more
  T const& back() const { return data_[size_ - 1]; }             ///< the last value, to be read

  /// Takes room for `capacity` values in all; the values move there.
  void reserve(std::size_t capacity) {
    static_assert(std::is_nothrow_move_constructible_v<T>, "a value in a Sequence must move without throwing");
    if (capacity <= capacity_) return;
    T* const fresh = static_cast<T*>(detail::take_memory(capacity, sizeof(T), alignof(T)));
    for (std::size_t i = 0; i < size_; ++i) {
      new (fresh + i) T(std::move(data_[i]));
      data_[i].~T();
    }
    detail::give_memory(data_, alignof(T));
    data_ = fresh;
    capacity_ = capacity;
  }
  /// Appends a value. All values move to a larger memory where the room is full.
  void push_back(T value) {
    if (size_ == capacity_) reserve(2 * size_ + 1);
    new (data_ + size_) T(std::move(value));
    ++size_;
  }
  /// Appends T(as…) and returns it.
  template <class... As>
  T& emplace_back(As&&... as) {
    push_back(T(std::forward<As>(as)...));
    return back();
  }
  void pop_back() { data_[--size_].~T(); }  ///< removes the last value, of one or more
  /// As many values as `size`; new ones are T().
  void resize(std::size_t size) {
    truncate(size);
    reserve(size);
    for (; size_ < size; ++size_) new (data_ + size_) T();
  }
  /// As many values as `size`; new ones are copies of `value`.
  void resize(std::size_t size, T const& value) {
    truncate(size);
    while (size_ < size) push_back(value);
  }
  /// Adds copies of the values in [first, last), which must not be of this Sequence.
  template <class It>
  void append(It first, It last) {
    for (; first != last; ++first) push_back(*first);
  }
  /// Replaces all values by `size` copies of `value`, which may be one of them.
  void assign(std::size_t size, T const& value) {
    T const kept = value;  // it may be one of these
    clear();
    reserve(size);
    for (; size_ < size; ++size_) new (data_ + size_) T(kept);
  }
  /// Keeps the first `size` values.
  void truncate(std::size_t size) noexcept {
    if constexpr (std::is_trivially_destructible_v<T>)
      size_ = size < size_ ? size : size_;
    else
      while (size_ > size) data_[--size_].~T();
  }
  void clear() noexcept { truncate(0); }  ///< removes all values and keeps the memory

 private:
  std::size_t within(std::size_t i) const {
    if (i >= size_) throw std::out_of_range("a Sequence has no value at the place that is asked for");
    return i;
  }
  void copy(T const* from, std::size_t size) {
    reserve(size);
    for (; size_ < size; ++size_) new (data_ + size_) T(from[size_]);
  }

  T* data_ = nullptr;
  std::size_t size_ = 0, capacity_ = 0;
};

/// Whether both have the same entries.
template <class T>
bool operator==(Sequence<T> const& a, Sequence<T> const& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end());
}

/// Removes the values of which `goes` is true.
template <class T, class F>
void erase_if(Sequence<T>& values, F const& goes) {
  std::size_t kept = 0;
  for (T& value : values)
    if (!goes(value)) values[kept++] = std::move(value);
  values.truncate(kept);
}

/// Sorts values and keeps one of those that are equal. Sorting by a heap compiles in less than half of std::sort's
/// time.
template <class T>
void sort_once(Sequence<T>& values) {
  std::make_heap(values.begin(), values.end());
  std::sort_heap(values.begin(), values.end());
  values.truncate(std::size_t(std::unique(values.begin(), values.end()) - values.begin()));
}

}  // namespace polybody
