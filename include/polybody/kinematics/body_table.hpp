#pragma once
/// \file
/// Storage of the bodies of one type, shared by a model and its handles.

#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include <polybody/math/sequence.hpp>
#include <polybody/math/types.hpp>

namespace polybody::detail {

/// Body of a model with the positions of its coordinates and velocities in the vectors of the model.
template <class B>
struct BodyTableEntry {
  B body;
  std::string name;
  Index q0;                   ///< index of its first coordinate in the model
  Index v0;                   ///< index of its first generalised velocity in the model
  Index row = -1;             ///< index of the first constraint equation of the body itself; −1 if it has none
  std::uint64_t made_in = 0;  ///< serial number of the model to which it was added
};

/// Array of the bodies of one type, stored by value, so that loops read them without indirection. Handles share the
/// array, which exists as long as the model or one of the handles. A copy of a model has a separate array.
template <class B>
class BodyTable {
 public:
  using Entry = BodyTableEntry<B>;

  BodyTable() = default;
  BodyTable(BodyTable const& other) {
    if (other.array_) array_ = std::make_shared<Sequence<Entry>>(*other.array_);
    see();
  }
  BodyTable(BodyTable&& other) noexcept : array_(std::move(other.array_)) {
    see();
    other.see();
  }
  BodyTable& operator=(BodyTable other) noexcept {
    array_.swap(other.array_);
    see();
    return *this;
  }
  ~BodyTable() = default;

  void push_back(Entry entry) {
    if (!array_) array_ = std::make_shared<Sequence<Entry>>();
    array_->push_back(std::move(entry));
    see();
  }

  std::size_t size() const { return size_; }
  Entry const& operator[](std::size_t i) const { return first_[i]; }
  Entry const& front() const { return *first_; }
  Entry const& back() const { return first_[size_ - 1]; }
  Entry const* begin() const { return first_; }
  Entry const* end() const { return first_ + size_; }

  /// Array that handles share with the model. It also contains bodies that are added later.
  std::shared_ptr<Sequence<Entry> const> shared() const { return array_; }

 private:
  void see() {
    first_ = array_ ? array_->data() : nullptr;
    size_ = array_ ? array_->size() : 0;
  }

  std::shared_ptr<Sequence<Entry>> array_;  ///< null until the first body is added
  Entry const* first_ = nullptr;            ///< first entry of the array
  std::size_t size_ = 0;
};

}  // namespace polybody::detail
