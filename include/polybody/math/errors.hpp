#pragma once
/// \file
/// The exceptions of the library. Each message names the object, where known the time, and the remedy.

#include <cstdio>
#include <stdexcept>
#include <string>

namespace polybody {

/// `x` as it stands in a message: up to nine digits.
inline std::string number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", x);
  return text;
}

/// Base of every exception that polybody throws.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A number, name or combination that cannot be meant: negative mass, zero axis, s outside the body.
class InvalidInput : public Error {
 public:
  using Error::Error;
};

/// A start that violates a joint; `assemble` repairs it.
class InconsistentStart : public Error {
 public:
  using Error::Error;
};

/// Newton's method did not converge; the state is as it was before the step.
class NewtonStalled : public Error {
 public:
  using Error::Error;
};

/// A step that converged, but left joints open or energy that no work explains; the state is as it was before the step.
class Diverged : public Error {
 public:
  using Error::Error;
};

/// A point that slides along a body has gone off its end.
class OffTheEnd : public Error {
 public:
  using Error::Error;
};

/// The step control asks for a step below the smallest one allowed.
class StepTooSmall : public Error {
 public:
  using Error::Error;
};

/// A force, mass or coordinate became NaN or infinite.
class NonFinite : public Error {
 public:
  using Error::Error;
};

/// The linear solver met a matrix without inverse.
class LinearSolverSingular : public Error {
 public:
  using Error::Error;
};

/// A file could not be read or written.
class IoError : public Error {
 public:
  using Error::Error;
};

}  // namespace polybody
