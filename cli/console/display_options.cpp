#include "cli/console/display_options.h"

#include "domelight/io/write_image.h"

#include <fmt/core.h>

#include <cmath>

namespace domelight::cli {

void add_display_options(Arguments& a, DisplayWords& w, const std::string& as_it_is, const std::string& other_zero) {
    a.choice("--tonemap", w.tonemap, fmt::format("tone map of a .png or .jpg (agx; none {})", as_it_is));
    a.number("--ev", "STOPS", w.ev,
             fmt::format("exposure of a .png or .jpg (from the log-average luminance; 0 {}{})", as_it_is, other_zero));
}

Result<void> check_display_options(const DisplayWords& w, const std::string& file) {
    if (!is_screen_picture(file))
        for (const auto& [option, given] : {std::pair{"--tonemap", w.tonemap.has_value()}, {"--ev", !std::isnan(w.ev)}})
            if (given)
                return Error{fmt::format("is of a .png or .jpg, and {} holds light as it is", file), option,
                             "--exposure multiplies the light."};
    if (std::isnan(w.ev) || std::abs(w.ev) <= 100) return {};
    return Error{fmt::format("{:g} is not from -100 to 100", w.ev), "--ev", ""};
}

Display display_of(const DisplayWords& w, bool for_screen, const std::function<double()>& automatic_ev) {
    const Tonemap usual = for_screen ? Tonemap::none : Tonemap::agx;
    const double ev = !std::isnan(w.ev) ? w.ev : for_screen ? 0 : automatic_ev();
    return {w.tonemap.value_or(usual), float(std::exp2(ev))};
}

}  // namespace domelight::cli
