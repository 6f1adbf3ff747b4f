#pragma once
/// \file
/// Threads that share loops. A loop is cut into as many contiguous parts as there are threads, so whoever writes to
/// places of its own writes the same whatever their number.

#include <algorithm>
#include <atomic>
#include <chrono>
#include <concepts>
#include <exception>
#include <system_error>
#include <thread>

#include <polybody/math/sequence.hpp>
#include <polybody/math/types.hpp>

namespace polybody {

/// The body of a loop over [begin, end). Its type is erased, so that `Workers` are compiled once.
class LoopBody {
 public:
  /// Calls f, which must outlive this.
  template <class F>
    requires(!std::same_as<std::remove_cvref_t<F>, LoopBody>)
  explicit LoopBody(F&& f)
      : body_(&f), call_([](void const* body, Index begin, Index end) {
          (*static_cast<std::remove_reference_t<F> const*>(body))(begin, end);
        }) {}
  /// Runs the body for the indices [begin, end).
  void operator()(Index begin, Index end) const { call_(body_, begin, end); }

 private:
  void const* body_;
  void (*call_)(void const*, Index, Index);
};

/// Threads that share the loops of an evaluation; results do not depend on how many there are.
class Workers {
 public:
  static constexpr int most = 4096;  ///< threads

  /// `threads` counts the caller: 1 starts none. \throws InvalidInput for less, and for more than the system starts.
  [[gnu::cold]] explicit Workers(int threads) : thrown_(std::size_t(std::clamp(threads, 0, most))) {
    if (threads < 1) throw InvalidInput{"Workers: at least one thread is needed, but ", threads, " are asked for."};
    if (threads > most)
      throw InvalidInput{"Workers: ", threads, " threads are asked for, more than the ", most,
                         " that are served. Ask for no more than there are processors."};
    try {
      for (int i = 1; i < threads; ++i) others_.emplace_back([this, i] { serve(i); });
    } catch (std::system_error const& error) {
      std::size_t const started = others_.size() + 1;
      end();
      throw InvalidInput{"Workers: of ",
                         threads,
                         " threads the system starts ",
                         started,
                         " only (",
                         error.what(),
                         "). Ask for no more than it has processors."};
    }
  }
  Workers(Workers const&) = delete;
  Workers& operator=(Workers const&) = delete;
  ~Workers() { end(); }

  int size() const { return int(thrown_.size()); }  ///< how many threads share a loop, the caller included

  /// Calls f(begin, end) for parts of [0, n) and returns when all are done. Parts begin at multiples of four and have
  /// no fewer than `least` entries, so a short loop stays with the caller. An exception of the first part that throws
  /// is passed on.
  void over(Index n, Index least, LoopBody const& f) {
    Index const parts = std::clamp<Index>(n / std::max<Index>(least, 1), 1, size());
    if (parts == 1) {
      f(0, n);
      return;
    }
    auto const part = [&](int i) {
      auto const cut = [&](Index k) { return k == parts ? n : n * k / parts / 4 * 4; };
      if (i < parts) f(cut(i), cut(i + 1));
    };
    using Part = decltype(part);
    call_ = [](void const* what, int i) { (*static_cast<Part const*>(what))(i); };
    what_ = &part;
    wake();
    run(0);
    for (unsigned left; (left = running_.load()) != 0;) wait_for_change(running_, left);
    for (std::exception_ptr& e : thrown_)
      if (e) {
        std::exception_ptr const first = e;
        std::fill(thrown_.begin(), thrown_.end(), nullptr);
        std::rethrow_exception(first);
      }
  }
  /// The same over [0, n), at `least` so many a worker, for any f that can be called as f(begin, end).
  template <class F>
  void over(Index n, Index least, F const& f) {
    over(n, least, LoopBody(f));
  }

 private:
  void end() {
    call_ = nullptr;
    wake();
    for (std::thread& t : others_) t.join();
  }
  void wake() {
    running_.store(unsigned(size() - 1));
    round_.fetch_add(1);
    round_.notify_all();
  }
  void run(int i) {
    try {
      call_(what_, i);
    } catch (...) {
      thrown_[std::size_t(i)] = std::current_exception();
    }
  }
  void serve(int i) {
    for (unsigned seen = 0;; ++seen) {
      wait_for_change(round_, seen);
      if (!call_) return;
      run(i);
      if (running_.fetch_sub(1) == 1) running_.notify_one();
    }
  }
  /// Looks for a tenth of a millisecond before it sleeps: the loops of a step follow one another within that, and to be
  /// woken takes half of it.
  static void wait_for_change(std::atomic<unsigned> const& x, unsigned old) {
    auto const end = std::chrono::steady_clock::now() + std::chrono::microseconds(100);
    do
      for (int i = 0; i < 100; ++i)
        if (x.load() != old) return;
    while (std::chrono::steady_clock::now() < end);
    x.wait(old);
  }

  Sequence<std::exception_ptr> thrown_;  // one for each thread
  void (*call_)(void const*, int) = nullptr;
  void const* what_ = nullptr;
  std::atomic<unsigned> round_{0}, running_{0};  // wrap around without harm
  Sequence<std::thread> others_;                 // last: they use the rest
};

/// f over [0, n), at `least` so many a worker, by `workers` where there are any.
template <class F>
void share(Workers* workers, Index n, Index least, F const& f) {
  LoopBody const body(f);
  if (workers)
    workers->over(n, least, body);
  else
    body(0, n);
}

}  // namespace polybody
