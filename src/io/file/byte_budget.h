#pragma once

#include "domelight/base/result.h"

#include <fmt/format.h>

#include <cstdint>
#include <string>

namespace domelight {

/// The memory that may still be allocated for a scene.
class ByteBudget {
  public:
    explicit ByteBudget(std::int64_t bytes) : limit_(bytes), left_(bytes) {}

    /// Reserves memory for `count` items of `bytes` each, described by `what`. Errors: not enough is left.
    Result<void> take(std::uint64_t count, std::uint64_t bytes, const std::string& what) {
        if (left_ < 0 || (bytes && count > std::uint64_t(left_) / bytes))
            return Error{fmt::format("{} would take the scene over the limit of {} bytes", what, limit_), "", ""};
        left_ -= std::int64_t(count * bytes);
        return {};
    }
    std::int64_t left() const { return left_; }

  private:
    std::int64_t limit_, left_;
};

}  // namespace domelight
