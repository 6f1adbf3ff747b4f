#pragma once
#include <polybody/system/system.hpp>

namespace polybody {

/// The rate of the coordinates themselves, q˙ = d/dε (q ⊞ ε v) at ε = 0: v itself where a body has as many coordinates
/// as speeds, else by dual numbers.
template <class M>
class CoordinateRate {
 public:
  explicit CoordinateRate(System<M> const& s)
      : q_(VecXOf<Dual<1>>::Zero(s.coordinates())), delta_(VecXOf<Dual<1>>::Zero(s.speeds())), out_(q_) {}

  /// \param rate (nq)
  template <class Rate>
  void operator()(System<M> const& system, VecX const& q, VecX const& v, Rate&& rate) {
    system.model().for_each_body([&](auto const& e) {
      Index const n = e.body.coordinates(), m = e.body.speeds();
      if (n == m) {
        for (Index i = 0; i < n; ++i) rate[e.q0 + i] = v[e.v0 + i];
        return;
      }
      for (Index i = 0; i < n; ++i) q_[e.q0 + i] = q[e.q0 + i];
      for (Index i = 0; i < m; ++i) delta_[e.v0 + i] = Dual<1>(0.0, Dual<1>::Partials::Constant(v[e.v0 + i]));
      e.body.template plus<Dual<1>>(detail::body_part(q_, e.q0, n), detail::body_part(delta_, e.v0, m),
                                    detail::body_part_of(out_, e.q0, n));
      for (Index i = 0; i < n; ++i) rate[e.q0 + i] = out_[e.q0 + i].d[0];
    });
  }

 private:
  VecXOf<Dual<1>> q_, delta_, out_;
};

}  // namespace polybody
