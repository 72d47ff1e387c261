#pragma once

#include "cli/console/arguments.h"
#include "preview/tonemap.h"

#include <functional>
#include <limits>
#include <optional>
#include <string>

namespace domelight::cli {

/// How radiance becomes a picture for a screen, as it was asked for.
struct DisplayWords {
    std::optional<Tonemap> tonemap;                        ///< nothing: agx, for pictures of 8 bits none
    double ev = std::numeric_limits<double>::quiet_NaN();  ///< NaN: automatic
};

/// --tonemap and --ev, of a .png or .jpg. For the help text: `as_it_is` says when a source is shown as it is ("for a
/// source of 8 bits"), and `other_zero` in which other cases the exposure is 0 by default.
void add_display_options(Arguments& arguments, DisplayWords& words, const std::string& as_it_is,
                         const std::string& other_zero = "");
/// Errors: --ev out of range; one of the two options where `file`, the output, is not a picture for a screen.
Result<void> check_display_options(const DisplayWords& words, const std::string& file);

/// What was asked for, with the rest filled in. `for_screen`: the source was made for a screen already and is shown as
/// it is. `automatic_ev` is called where the exposure is to be found.
Display display_of(const DisplayWords& words, bool for_screen, const std::function<double()>& automatic_ev);

}  // namespace domelight::cli
