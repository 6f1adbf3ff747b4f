#pragma once
/// \file
/// Contiguous array with short compile times.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <new>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include <polybody/math/compiler.hpp>

namespace polybody {
namespace detail {

/// Allocates memory for `count` values of `size` bytes each. Throws std::bad_alloc.
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

/// Contiguous array of values. It has the usual members of std::vector, with the same meaning, and compiles in one
/// third of the time (`bench/compile --containers`). The library stores its own arrays as Sequences; users pass a
/// std::vector or a span.
template <class T>
class Sequence {
 public:
  using value_type = T;  ///< type of the values, named as in std::vector

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
  Sequence(Sequence&& other) noexcept { swap(other); }  ///< moves the memory of `other`, which becomes empty
  /// Copies all values of `other`; keeps its own memory if it is large enough.
  Sequence& operator=(Sequence const& other) {
    if (this != &other) {
      clear();
      copy(other.data_, other.size_);
    }
    return *this;
  }
  /// Moves the memory of `other`, which becomes empty.
  Sequence& operator=(Sequence&& other) noexcept {
    Sequence taken(std::move(other));
    swap(taken);
    return *this;
  }
  ~Sequence() {
    clear();
    detail::give_memory(data_, alignof(T));
  }

  /// Exchanges the memory of both arrays; no value is moved.
  void swap(Sequence& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    std::swap(capacity_, other.capacity_);
  }

  T* data() { return data_; }                                    ///< values in memory; null if no memory is allocated
  T const* data() const { return data_; }                        ///< values in memory, read-only
  T* begin() { return data_; }                                   ///< first value
  T const* begin() const { return data_; }                       ///< first value, read-only
  T* end() { return data_ + size_; }                             ///< end of the values
  T const* end() const { return data_ + size_; }                 ///< end of the values
  std::size_t size() const { return size_; }                     ///< number of values
  bool empty() const { return size_ == 0; }                      ///< true if there are no values
  T& operator[](std::size_t i) { return data_[i]; }              ///< value i; the range of i is not checked
  T const& operator[](std::size_t i) const { return data_[i]; }  ///< value i, read-only
  /// Value number `i`. \throws std::out_of_range unless i < size().
  T& at(std::size_t i) { return data_[within(i)]; }
  T const& at(std::size_t i) const { return data_[within(i)]; }  ///< value number `i`, read-only
  T& front() { return *data_; }                                  ///< first value; the array must not be empty
  T const& front() const { return *data_; }                      ///< first value, read-only
  T& back() { return data_[size_ - 1]; }                         ///< last value; the array must not be empty
  T const& back() const { return data_[size_ - 1]; }             ///< last value, read-only

  /// Ensures memory for `capacity` values in total. If the memory is too small, all values move to new memory.
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
  /// Appends `value`. If the memory is full, all values move to larger memory.
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
  void pop_back() { data_[--size_].~T(); }  ///< removes the last value; the array must not be empty
  /// Changes the number of values to `size`; new values are T().
  void resize(std::size_t size) {
    truncate(size);
    reserve(size);
    for (; size_ < size; ++size_) new (data_ + size_) T();
  }
  /// Changes the number of values to `size`; new values are copies of `value`.
  void resize(std::size_t size, T const& value) {
    truncate(size);
    while (size_ < size) push_back(value);
  }
  /// Appends copies of the values in [first, last), which must not belong to this Sequence.
  template <class It>
  void append(It first, It last) {
    for (; first != last; ++first) push_back(*first);
  }
  /// Replaces all values by `size` copies of `value`, which may belong to this Sequence.
  void assign(std::size_t size, T const& value) {
    T const kept = value;  // `value` may belong to this Sequence
    clear();
    reserve(size);
    for (; size_ < size; ++size_) new (data_ + size_) T(kept);
  }
  /// Removes all values except the first `size` ones.
  void truncate(std::size_t size) noexcept {
    if constexpr (std::is_trivially_destructible_v<T>)
      size_ = size < size_ ? size : size_;
    else
      while (size_ > size) data_[--size_].~T();
  }
  void clear() noexcept { truncate(0); }  ///< removes all values and keeps the memory

 private:
  std::size_t within(std::size_t i) const {
    if (i >= size_) throw std::out_of_range("Sequence::at: the index is not below the number of values");
    return i;
  }
  void copy(T const* from, std::size_t size) {
    reserve(size);
    for (; size_ < size; ++size_) new (data_ + size_) T(from[size_]);
  }

  T* data_ = nullptr;
  std::size_t size_ = 0, capacity_ = 0;
};

/// True if both arrays have the same size and equal values.
template <class T>
bool operator==(Sequence<T> const& a, Sequence<T> const& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end());
}

/// Removes all values for which `goes(value)` returns true.
template <class T, class F>
void erase_if(Sequence<T>& values, F const& goes) {
  std::size_t kept = 0;
  for (T& value : values)
    if (!goes(value)) values[kept++] = std::move(value);
  values.truncate(kept);
}

/// Sorts the values and removes duplicates. The heap sort compiles in less than half of the time of std::sort.
template <class T>
void sort_once(Sequence<T>& values) {
  std::make_heap(values.begin(), values.end());
  std::sort_heap(values.begin(), values.end());
  values.truncate(std::size_t(std::unique(values.begin(), values.end()) - values.begin()));
}

}  // namespace polybody
