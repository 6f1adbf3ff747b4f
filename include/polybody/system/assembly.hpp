#pragma once
/// \file
/// Assembly of right-hand sides, and products with the constraint Jacobian G, as loops over constraint blocks and
/// applied wrenches. The loops do not depend on the type of the model.

#include <polybody/system/layout.hpp>
#include <polybody/system/projected_stiffness.hpp>

namespace polybody {

namespace detail {

/// Calls f(block) for all blocks with constraint equations of the model, except blocks that the evaluation omits.
template <StateScalar T, class F>
void for_each_row_block(Data<T> const& data, F&& f) {
  for (ConstraintBlock<T> const& block : data.rows)
    if (block.row >= 0 && !data.leaves_out(block)) f(block);
}

/// r += mapᵀ λ of both ends of a block. \tparam m number of constraint equations; 0 stands for block.rows
template <int m, StateScalar T>
void add_ends(ConstraintBlock<T> const& block, T const* lambda, Data<T> const& data, T* r) {
  if constexpr (m > 0)
    if (block.opposite) {
      T w[6];
      wrench_of<m>(block.a.map, lambda, w);
      add_pulled(data.markers[std::size_t(block.a.marker)], w, 1.0, r);
      return add_pulled(data.markers[std::size_t(block.b.marker)], w, -1.0, r);
    }
  for (ConstraintSide<T> const* const end : {&block.a, &block.b}) {
    if (end->marker < 0) {
      int const rows = m > 0 ? m : block.rows;
      for (Index c = 0; c < end->columns; ++c)
        for (int k = 0; k < rows; ++k) r[end->first + c] += end->map[rows * c + k] * lambda[k];
    } else if constexpr (m > 0) {
      MarkerKinematics<T> const& p = data.markers[std::size_t(end->marker)];
      if (p.shape == JacobianShape::ground) continue;
      T w[6];
      wrench_of<m>(end->map, lambda, w);
      add_pulled(p, w, 1.0, r);
    }
  }
}
/// Overload for m = block.rows.
template <StateScalar T>
void add_ends(ConstraintBlock<T> const& block, T const* lambda, Data<T> const& data, T* r) {
  with_constant(block.rows, [&](auto m) { add_ends<m>(block, lambda, data, r); });
}

/// out (rows) += map · x for one end of a block. x is the twist of its marker in the evaluated state. For an end
/// without a marker, x are the velocities of the end in v.
template <StateScalar T>
void add_rate(ConstraintSide<T> const& end, int rows, Data<T> const& data, VecXOf<T> const& v, T* out) {
  T twist[6];
  T const* x = v.data() + end.first;
  if (end.marker >= 0) {
    read_twist(data.markers[std::size_t(end.marker)].frame, twist);
    x = twist;
  }
  add_mapped<0>(end.map, end.columns, x, rows, out);
}
/// out (rows) += map · x for one end of a block. x is the twist J b of its marker for any vector b (nv). For an end
/// without a marker, x are the entries of the end in b.
template <StateScalar T>
void add_product(ConstraintSide<T> const& end, int rows, Data<T> const& data, VecXOf<T> const& b, T* out) {
  Vec<T, 6> twist;
  T const* x = b.data() + end.first;
  if (end.marker >= 0) {
    MarkerKinematics<T> const& p = data.markers[std::size_t(end.marker)];
    if (p.shape == JacobianShape::ground) return;
    twist = p.push(b.data() + p.first);
    x = twist.data();
  }
  add_mapped<0>(end.map, end.columns, x, rows, out);
}

}  // namespace detail

/// r += Gᵀλ of all constraint equations and of compliant joints, whose λ(g, ġ) is the force of their policy.
template <StateScalar T>
void add_row_forces(Data<T> const& data, VecXOf<T> const& lambda, VecXOf<T>& r) {
  for (ConstraintBlock<T> const& block : data.rows) {
    if (data.leaves_out(block)) continue;
    T const* const l = block.multiplier(lambda);
    detail::add_ends(block, l, data, r.data());
  }
}

/// r −= Jᵀw of all force elements. The wrenches of loads are multiplied by `load_factor`.
template <StateScalar T>
void add_actions(Data<T> const& data, ModelLayout const& layout, double load_factor, VecXOf<T>& r) {
  for (AppliedWrench<T> const& action : data.actions) {
    double const scale = layout.forces[std::size_t(action.source)].is_load ? load_factor : 1.0;
    detail::add_pulled(data.markers[std::size_t(action.marker)], action.w, -scale, r.data());
  }
}

/// `phi` = Φ (rows), the constraint violation; zero for nonholonomic equations.
template <StateScalar T>
void violation(Data<T> const& data, VecXOf<T>& phi) {
  detail::for_each_row_block(data, [&](ConstraintBlock<T> const& block) {
    for (int i = 0; i < block.rows; ++i) phi[block.row + i] = block.g[i];
  });
}

/// `rate` = Φ̇ = G v + Φ_t (rows).
template <StateScalar T>
void violation_rate(Data<T> const& data, VecXOf<T> const& v, VecXOf<T>& rate) {
  detail::for_each_row_block(data, [&](ConstraintBlock<T> const& block) {
    T* const out = rate.data() + block.row;
    for (int i = 0; i < block.rows; ++i) out[i] = block.rate ? block.rate[i] : T(0.0);
    detail::add_rate(block.a, block.rows, data, v, out);
    detail::add_rate(block.b, block.rows, data, v, out);
  });
}

/// gamma (rows) += map · bias of both ends of each block: the contribution of the bias accelerations of the markers to
/// γ.
template <StateScalar T>
void add_biases(Data<T> const& data, VecXOf<T>& gamma) {
  detail::for_each_row_block(data, [&](ConstraintBlock<T> const& block) {
    for (ConstraintSide<T> const* const end : {&block.a, &block.b})
      if (end->marker >= 0)
        detail::add_mapped<0>(end->map, 6, data.markers[std::size_t(end->marker)].bias.data(), block.rows,
                              gamma.data() + block.row);
  });
}

/// out = G b (rows) for b (nv).
template <StateScalar T>
void rows_times(Data<T> const& data, VecXOf<T> const& b, VecXOf<T>& out) {
  for (Index i = 0; i < out.size(); ++i) out[i] = T(0.0);
  detail::for_each_row_block(data, [&](ConstraintBlock<T> const& block) {
    detail::add_product(block.a, block.rows, data, b, out.data() + block.row);
    detail::add_product(block.b, block.rows, data, b, out.data() + block.row);
  });
}

/// out = Gᵀ b (nv) for b (rows).
template <StateScalar T>
void rows_transposed_times(Data<T> const& data, VecXOf<T> const& b, VecXOf<T>& out) {
  for (Index i = 0; i < out.size(); ++i) out[i] = T(0.0);
  detail::for_each_row_block(
      data, [&](ConstraintBlock<T> const& block) { detail::add_ends(block, b.data() + block.row, data, out.data()); });
}

/// Writes the blocks of Gᵀ and G into `sink`. \param first first row of G in the matrix
template <class = void>
void write_rows(Data<double>& data, Index first, BlockSink& sink) {
  detail::for_each_row_block(data, [&](ConstraintBlock<double> const& block) {
    Index const row = first + block.row;
    for (ConstraintSide<double> const* const end : {&block.a, &block.b}) {
      if (end->marker >= 0) {
        with_constant(block.rows, [&](auto m) {
          if constexpr (m > 0)
            detail::add_pulled_rows<m>(data.markers[std::size_t(end->marker)], end->map, row, data.scratch, sink);
        });
      } else if (end->columns > 0) {
        sink.add(end->first, row, BlockView(end->map, end->columns, block.rows, block.rows, 1));
        sink.add(row, end->first, BlockView(end->map, block.rows, end->columns, 1, block.rows));
      }
    }
  });
}

}  // namespace polybody
