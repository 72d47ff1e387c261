#pragma once

#include <functional>
#include <string_view>

namespace domelight {

/// Long work tells how far it is: a stage's name ("filter") and the part of it that is done, 0 to 1. Called from one
/// thread at a time. Returning false asks the work to stop; it then returns an Error with `what` "cancelled".
using Progress = std::function<bool(std::string_view stage, double done)>;

}  // namespace domelight
