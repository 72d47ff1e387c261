#pragma once
// Errors of the library as Python's exceptions.

#include "domelight/base/result.h"

#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>

#include <exception>
#include <utility>

namespace domelight::python {

namespace nb = nanobind;

/// An error on its way to Python, where domelight._errors makes a domelight.Error of it.
class Failure : public std::exception {
  public:
    explicit Failure(Error error) : error_(std::move(error)) {}
    const Error& error() const { return error_; }
    const char* what() const noexcept override { return error_.what.c_str(); }

  private:
    Error error_;
};

/// The value, or its error thrown as a Failure.
template <typename T>
T value_of(Result<T> result) {
    if (!result) throw Failure(result.error());
    return *std::move(result);
}
inline void value_of(const Result<void>& result) {
    if (!result) throw Failure(result.error());
}

/// Has each Failure that leaves a function of this module raised as a domelight.Error.
void register_errors();

}  // namespace domelight::python
