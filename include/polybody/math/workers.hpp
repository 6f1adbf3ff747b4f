#pragma once
/// \file
/// Threads that share loops. A loop is divided into at most one contiguous part per thread. If each index writes to its
/// own memory, the results do not depend on the number of threads.

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

/// Body of a loop over [begin, end) with erased type, so that `Workers` is compiled once.
class ParallelBody {
 public:
  /// Refers to f, which must outlive this object.
  template <class F>
    requires(!std::same_as<std::remove_cvref_t<F>, ParallelBody>)
  explicit ParallelBody(F&& f)
      : body_(&f), call_([](void const* body, Index begin, Index end) {
          (*static_cast<std::remove_reference_t<F> const*>(body))(begin, end);
        }) {}
  /// Executes the body for the indices [begin, end).
  void operator()(Index begin, Index end) const { call_(body_, begin, end); }

 private:
  void const* body_;
  void (*call_)(void const*, Index, Index);
};

/// Threads that share the loops of an evaluation.
class Workers {
 public:
  static constexpr int most = 4096;  ///< largest number of threads

  /// Starts `threads` − 1 threads; the calling thread is the first one. \throws InvalidInput for `threads` < 1 or >
  /// `most`, and if the system cannot start all threads.
  [[gnu::cold]] explicit Workers(int threads) : thrown_(std::size_t(std::clamp(threads, 0, most))) {
    if (threads < 1)
      throw InvalidInput("workers.count", {ErrorObject{"Workers"}, ": at least one thread is needed, but ",
                                           ErrorValue{threads}, " are requested."});
    if (threads > most)
      throw InvalidInput("workers.count", {ErrorObject{"Workers"}, ": ", ErrorValue{threads},
                                           " threads are requested, but the largest number is ", most,
                                           ". Request at most as many as there are processors."});
    try {
      for (int i = 1; i < threads; ++i) others_.emplace_back([this, i] { serve(i); });
    } catch (std::system_error const& error) {
      std::size_t const started = others_.size() + 1;
      end();
      throw InvalidInput("workers.start",
                         {ErrorObject{"Workers"}, ": the operating system starts only ", ErrorValue{started}, " of ",
                          threads, " threads (", error.what(), "). Request at most as many as there are processors."});
    }
  }
  Workers(Workers const&) = delete;
  Workers& operator=(Workers const&) = delete;
  ~Workers() { end(); }

  int size() const { return int(thrown_.size()); }  ///< number of threads that share a loop, including the calling one

  /// Calls f(begin, end) for parts of [0, n) and returns when all parts are complete. The number of parts is n/`least`,
  /// limited to the range from one to `size()`. Parts begin at multiples of four. The calling thread executes a loop of
  /// one part alone. If several parts throw, the exception of the first of them is thrown again.
  void over(Index n, Index least, ParallelBody const& f) {
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
  /// Overload for any f that is callable as f(begin, end). The number of parts of [0, n) is n/`least`,
  /// limited to the range from one to `size()`.
  template <class F>
  void over(Index n, Index least, F const& f) {
    over(n, least, ParallelBody(f));
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
  /// Waits until x differs from `old`: polls for 0.1 ms, then sleeps. The loops of a step follow each other within 0.1
  /// ms, and waking a thread takes half of this time.
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
  std::atomic<unsigned> round_{0}, running_{0};  // an overflow of round_ is harmless
  Sequence<std::thread> others_;                 // last member: the threads use the other members
};

/// Calls f(begin, end) for parts of [0, n) on the threads of `workers`. The number of parts is n/`least`, limited to
/// the range from one to the number of threads. Calls f(0, n) if `workers` is null.
template <class F>
void share(Workers* workers, Index n, Index least, F const& f) {
  ParallelBody const body(f);
  if (workers)
    workers->over(n, least, body);
  else
    body(0, n);
}

}  // namespace polybody
