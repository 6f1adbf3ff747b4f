#pragma once
/// \file
/// Identity of a model. Serial numbers distinguish the handles of a model from those of other models. Objects that keep
/// a reference to a model detect its changes from a count.

#include <atomic>
#include <cstdint>
#include <memory>
#include <utility>

#include <polybody/math/errors.hpp>
#include <polybody/math/sequence.hpp>

namespace polybody {

namespace detail {

/// Returns a new serial number for a model.
inline std::uint64_t next_serial() noexcept {
  static std::atomic<std::uint64_t> last{0};
  return ++last;
}

/// Count of the changes of a model. It outlives the model as long as a watch refers to it.
struct ModelHistory {
  std::uint64_t changes = 1;  ///< number of additions, moves and destructions, plus one
  std::uint64_t moved = 0;    ///< value of `changes` at the last move to another object; 0: no move
  bool ended = false;         ///< true after the model is destroyed or another one is assigned to it
};

}  // namespace detail

/// Detector of changes of a model to which a run, system or recorder keeps a reference. A default-constructed watch
/// detects no changes.
class ModelWatch {
 public:
  ModelWatch() = default;
  /// Starts to watch a model. \param history change count of the model
  explicit ModelWatch(std::shared_ptr<detail::ModelHistory const> history) : history_(std::move(history)) {
    if (history_) changes_ = history_->changes;
  }

  /// \throws InvalidInput if a part was added, or the model was moved or destroyed, after the construction of the
  /// watch.
  void require_unchanged() const {
    if (history_ && history_->changes != changes_) refuse();
  }

 private:
  template <class = void>
  [[noreturn, gnu::cold]] void refuse() const {
    if (history_->moved > changes_)
      throw InvalidInput("model.moved",
                         {"The model was moved to another object while a run, system or recorder refers to it. "
                          "Construct these after the last move, or hold the model in a std::unique_ptr."});
    if (history_->ended)
      throw InvalidInput("model.destroyed", {"The model was destroyed or assigned to while a run, system or recorder "
                                             "refers to it. Keep the model in a variable that outlives them."});
    throw InvalidInput("model.changed",
                       {"A body, joint or force was added to the model while a run, system or recorder refers to it. "
                        "Construct these after the last addition, or from a copy of the model."});
  }

  std::shared_ptr<detail::ModelHistory const> history_;
  std::uint64_t changes_ = 0;
};

namespace detail {

/// Identity of one model. A copy gets a new serial number and keeps the serial numbers of its ancestors. A move
/// transfers the identity; the source gets the identity of a new, empty model.
class ModelOrigin {
 public:
  ModelOrigin() = default;
  ModelOrigin(ModelOrigin const& other) : ancestors_(other.ancestors_) { ancestors_.push_back(other.serial_); }
  ModelOrigin(ModelOrigin&& other) noexcept
      : serial_(std::exchange(other.serial_, next_serial())),
        ancestors_(std::move(other.ancestors_)),
        history_(std::move(other.history_)) {
    if (history_) history_->moved = ++history_->changes;
  }
  ModelOrigin& operator=(ModelOrigin other) noexcept {  // the destructor of `other` ends the previous identity
    std::swap(serial_, other.serial_);
    ancestors_.swap(other.ancestors_);
    history_.swap(other.history_);
    return *this;
  }
  ~ModelOrigin() {
    if (!history_) return;
    ++history_->changes;
    history_->ended = true;
  }

  std::uint64_t serial() const { return serial_; }
  Sequence<std::uint64_t> const& ancestors() const { return ancestors_; }
  /// Counts a change. Call it before a part is added.
  void change() {
    if (!history_) history_ = std::make_shared<ModelHistory>();
    ++history_->changes;
  }
  ModelWatch watch() const { return ModelWatch(history_); }

 private:
  std::uint64_t serial_ = next_serial();
  Sequence<std::uint64_t> ancestors_;
  std::shared_ptr<ModelHistory> history_;  ///< null before the first part is added
};

/// True if a model accepts ground markers of the model with serial number `given`. `serial` and `ancestors` are its own
/// number and those of its ancestors.
inline bool accepts(std::uint64_t serial, Sequence<std::uint64_t> const& ancestors, std::uint64_t given) {
  return given == serial || std::find(ancestors.begin(), ancestors.end(), given) != ancestors.end();
}

}  // namespace detail

}  // namespace polybody
