#pragma once

#include "domelight/image/row_source.h"

#include <functional>

namespace domelight {

/// A RowSource that also passes every block of rows to a function, so that one reading serves several uses.
class TapRowSource : public RowSource {
  public:
    using Tap = std::function<void(ImageView<const float> rows)>;

    TapRowSource(RowSource& source, Tap tap) : source_(source), tap_(std::move(tap)) {}
    int width() const override { return source_.width(); }
    int height() const override { return source_.height(); }
    Result<void> read(ImageView<float> rows) override {
        auto ok = source_.read(rows);
        if (ok && tap_) tap_(rows);
        return ok;
    }

  private:
    RowSource& source_;
    Tap tap_;
};

}  // namespace domelight
