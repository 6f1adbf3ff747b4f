#pragma once
/// \file
/// Models, rigid, ANCF and LRVF bodies, joints, forces, integrators, runs, probes, statics, tables and figures. Each
/// further subject has its own header, because its compile time is large or few programs need it:
///   polybody/ffr.hpp           bodies in the floating frame of reference
///   polybody/formulations.hpp  further formulations of bodies, and systems with user-defined equations
///   polybody/vibration.hpp     modes, buckling, steady rotation, diagnosis of a model
///   polybody/comparison.hpp    comparison of formulations at equal error, reports
///   polybody/stress.hpp        stresses of bodies, filters, rainflow counts
///   polybody/gradients.hpp     derivatives of runs with respect to parameters
///   polybody/film.hpp          films, pictures of modes, files for ParaView
///   polybody/study.hpp         parameter studies, checkpoints
///   polybody/vehicle.hpp       tracked vehicles
///   polybody/urdf.hpp          models from URDF files, with liburdfdom
///   polybody/solvers.hpp       further linear solvers
///   polybody/testing.hpp       test suites for user-defined bodies, joints and integrators

#include <polybody/math/compiler.hpp>  // first: an unsuitable compiler gives a single error message

// Headers that reject invalid combinations come first: the compiler's message begins with the chain of includes, which
// is then short.
#include <polybody/joints/joint.hpp>
#include <polybody/joints/relative_coordinates.hpp>
#include <polybody/math/time_functions.hpp>
#include <polybody/system/model.hpp>

#include <polybody/integrators/system_for.hpp>

#include <polybody/bodies/ancf/ancf_beam.hpp>
#include <polybody/bodies/ancf/ancf_cable.hpp>
#include <polybody/bodies/ancf/ancf_coupled_line.hpp>
#include <polybody/bodies/ancf/planar_ancf_cable.hpp>
#include <polybody/bodies/lrvf/lrvf.hpp>
#include <polybody/bodies/lrvf/planar_lrvf.hpp>
#include <polybody/bodies/rigid/inertia.hpp>
#include <polybody/bodies/rigid/mesh_file.hpp>
#include <polybody/bodies/rigid/planar_rigid.hpp>
#include <polybody/bodies/rigid/rigid.hpp>
#include <polybody/bodies/rigid/rigid_euler_parameters.hpp>
#include <polybody/bodies/shared/catenary.hpp>
#include <polybody/bodies/shared/node_chain.hpp>
#include <polybody/bodies/shared/sections.hpp>
#include <polybody/bodies/shared/with_sliders.hpp>
#include <polybody/compare/compare.hpp>
#include <polybody/compare/mesh_diagnostics.hpp>
#include <polybody/compare/work_precision.hpp>
#include <polybody/forces/contact.hpp>
#include <polybody/forces/contact_group.hpp>
#include <polybody/forces/gravity.hpp>
#include <polybody/forces/loads.hpp>
#include <polybody/forces/springs.hpp>
#include <polybody/forces/user_force.hpp>
#include <polybody/integrators/adams_bashforth_moulton.hpp>
#include <polybody/integrators/coordinate_partitioning.hpp>
#include <polybody/integrators/energy_momentum.hpp>
#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/integrators/radau.hpp>
#include <polybody/integrators/runge_kutta.hpp>
#include <polybody/integrators/symplectic.hpp>
#include <polybody/io/comparison_report.hpp>
#include <polybody/io/csv.hpp>
#include <polybody/io/plot.hpp>
#include <polybody/io/progress.hpp>
#include <polybody/io/run_table.hpp>
#include <polybody/io/visual.hpp>
#include <polybody/joints/driving_constraints.hpp>
#include <polybody/joints/gears.hpp>
#include <polybody/joints/nonholonomic.hpp>
#include <polybody/joints/planar/joints.hpp>
#include <polybody/joints/policies/bushing.hpp>
#include <polybody/joints/standard_joints.hpp>
#include <polybody/math/monotone_table.hpp>
#include <polybody/math/smooth_table.hpp>
#include <polybody/run/accelerations.hpp>
#include <polybody/run/any_model.hpp>
#include <polybody/run/applied_wrenches.hpp>
#include <polybody/run/energy.hpp>
#include <polybody/run/energy_audit.hpp>
#include <polybody/run/initial_conditions.hpp>
#include <polybody/run/joint_position.hpp>
#include <polybody/run/marker_frames.hpp>
#include <polybody/run/minimum_norm.hpp>
#include <polybody/run/observe.hpp>
#include <polybody/run/probe.hpp>
#include <polybody/run/problem_size.hpp>
#include <polybody/run/redundancy.hpp>
#include <polybody/run/simulate.hpp>
#include <polybody/run/sliders.hpp>
#include <polybody/solvers/auto_lu.hpp>
#include <polybody/solvers/block_factor.hpp>
#include <polybody/solvers/default_solver.hpp>
#include <polybody/solvers/iterative_refinement.hpp>
#include <polybody/statics/arc_length.hpp>
#include <polybody/statics/equilibrium.hpp>
#include <polybody/statics/preloads.hpp>
#include <polybody/system/subassembly.hpp>
#include <polybody/version.hpp>
