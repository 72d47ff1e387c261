#pragma once

#include <functional>
#include <string_view>

namespace domelight {

/// Reports the progress of long work: the name of a stage ("filter") and the part of it that is done, 0 to 1. Called
/// from one thread at a time. If it returns false, the work stops and returns an Error whose `what` is "cancelled".
using Progress = std::function<bool(std::string_view stage, double done)>;

}  // namespace domelight
