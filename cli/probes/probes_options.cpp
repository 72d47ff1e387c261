#include "cli/probes/probes_options.h"

#include "domelight/engines/engine.h"
#include "domelight/scene/scene.h"

#include "cli/console/point_options.h"
#include "cli/probes/probes_engines.h"

#include <fmt/core.h>

#include <cmath>

namespace domelight::cli {
namespace {

/// "X,Y,Z" in metres.
Result<Vec3f> parse_place(const std::string& text) {
    const auto words = split(text, ',');
    const Error wrong{fmt::format("\"{}\" is not three numbers", text), "--at", "x,y,z in metres"};
    if (words.size() != 3) return wrong;
    double v[3];
    for (std::size_t i = 0; i < 3; ++i) {
        const auto number = parse_number(words[i]);
        if (!number) return wrong;
        if (!(std::abs(*number) <= 1e9))
            return Error{fmt::format("{} is not finite and within 1e9 metres", words[i]), "--at", "x,y,z in metres"};
        v[i] = *number;
    }
    return Vec3f(Vec3d{v[0], v[1], v[2]});
}

Result<void> check_numbers(const ProbesWords& w, const Arguments& a) {
    const struct {
        const char* option;
        double value, low, high;
    } ranges[] = {{"--size", double(w.size.value_or(64)), 8, 1024},
                  {"--spp", double(w.spp.value_or(32)), 1, 1 << 20},
                  {"--bounces", double(w.bounces.value_or(3)), 0, 1000},
                  {"--noise", w.noise, 0, 1},
                  {"--lux-per-unit", w.lux_per_unit, 1e-12, 1e12},
                  {"--budget", a.given("--budget") ? w.budget : 1, 1e-3, 1e9},
                  {"--levels", double(w.levels.value_or(2)), 2, 11},
                  {"--irradiance-size", double(w.irradiance_size.value_or(16)), 1, 256},
                  {"--distance-size", double(w.distance_size.value_or(0)), 0, 1024},
                  {"--density", a.given("--density") ? w.density : 1, 1e-9, 1e9},
                  {"--auto", double(w.auto_count.value_or(8)), 8, 1 << 20},
                  {"--nearest", a.given("--nearest") ? w.nearest : 1, 1e-6, 1e6},
                  {"--farthest", a.given("--farthest") ? w.farthest : 1, 0, 1e6}};
    for (const auto& r : ranges)
        if (auto ok = within(r.option, r.value, r.low, r.high); !ok) return ok;
    return {};
}

Result<void> check_region(const ProbesWords& w) {
    if (w.region.empty()) return {};
    if (w.region.size() != 6) return Error{"needs six numbers", "--region", "x0,y0,z0,x1,y1,z1"};
    for (const double v : w.region)
        if (!(std::abs(v) <= 1e9))
            return Error{fmt::format("{:g} is not finite and within 1e9 metres", v), "--region", ""};
    return {};
}

Result<void> check_placement(ProbesWords& w, const Arguments& a) {
    const int ways = int(a.given("--grid")) + int(a.given("--density")) + int(a.given("--at")) + int(a.given("--auto"));
    if (ways != 1)
        return Error{ways == 0 ? "is missing" : "are given together", "--grid, --density, --at, --auto",
                     "Say in one of these ways where the probes are to be."};
    if (!w.grid.empty()) {
        if (w.grid.size() != 3) return Error{"needs three numbers", "--grid", "nx,ny,nz"};
        for (const double n : w.grid)
            if (!(n >= 1 && n <= 4096 && n == std::floor(n)))
                return Error{fmt::format("{:g} is not a number of places from 1 to 4096", n), "--grid", ""};
    }
    if (a.given("--at") && a.given("--region"))
        return Error{"goes with --grid, --density and --auto only", "--region", ""};
    for (const std::string& text : w.at) {
        const auto place = parse_place(text);
        if (!place) return place.error();
        w.places.push_back(*place);
    }
    if (w.auto_count)
        for (const char* option : {"--nearest", "--farthest"})
            if (a.given(option))
                return Error{"has no meaning with --auto, which goes by the size of its cells", option, ""};
    return check_region(w);
}

Result<ProbeBox> parse_box(const std::string& text, const char* option, const char* hint) {
    const Error wrong{fmt::format("\"{}\" is none of them", text), option, hint};
    double v[6];
    const auto words = split(text, ',');
    if (words.size() != 6) return wrong;
    for (std::size_t i = 0; i < 6; ++i) {
        const auto number = parse_number(words[i]);
        if (!number || !(std::abs(*number) <= 1e9)) return wrong;
        v[i] = *number;
    }
    const ProbeBox box{Vec3f(Vec3d{v[0], v[1], v[2]}), Vec3f(Vec3d{v[3], v[4], v[5]})};
    if (box.low.x < box.high.x && box.low.y < box.high.y && box.low.z < box.high.z) return box;
    return Error{fmt::format("\"{}\" is a box without volume", text), option,
                 "The second corner must have the larger coordinates."};
}

/// --proxy and --influence.
Result<void> check_boxes(ProbesWords& w) {
    if (w.proxy != "room" && w.proxy != "none") {
        const auto box = parse_box(w.proxy, "--proxy", "Accepted: room, none, x0,y0,z0,x1,y1,z1.");
        if (!box) return box.error();
        w.box = *box;
    }
    if (w.influence == "everywhere") return {};
    if (w.influence == "room") {
        if (w.proxy == "none") return Error{"room is the box of --proxy, which is none", "--influence", ""};
        w.shape = ProbeInfluence::Shape::box;
        return {};
    }
    const auto radius = parse_number(w.influence);
    if (!radius || !(*radius > 0 && *radius <= 1e9))
        return Error{fmt::format("\"{}\" is none of them", w.influence), "--influence",
                     "Accepted: everywhere, room, a radius in metres above 0."};
    w.shape = ProbeInfluence::Shape::sphere;
    w.radius = float(*radius);
    return {};
}

}  // namespace

CaptureOptions ProbesWords::capture() const {
    CaptureOptions o;
    o.size = size.value_or(64);
    o.samples = spp.value_or(32);
    o.noise = noise;
    o.most_samples = std::max(1024, 16 * o.samples);
    o.bounces = bounces.value_or(3);
    o.seed = std::uint64_t(seed.value_or(0));
    o.threads = threads();
    return o;
}

Result<void> check_words(ProbesWords& w, const Arguments& a) {
    for (const std::string& engine : w.engines)
        if (auto known = find_engine(engine); !known) return known.error().at("--for");
    if (names_a_set(w)) return check_engine_words(w, a);
    if (w.scenes.size() != 1)
        return Error{w.scenes.empty() ? "is missing" : "is given twice", "SCENE",
                     fmt::format("One model, or a built-in scene: {}.", join(built_in_scene_names(), ", "))};
    if (!w.check.empty()) {
        for (const char* option : {"--output", "--grid", "--density", "--at", "--auto", "--for"})
            if (a.given(option)) return Error{"has no meaning with --check", option, ""};
        return within("--lux-per-unit", w.lux_per_unit, 1e-12, 1e12);
    }
    if (w.output.empty()) return Error{"is missing", "--output", "Say where the probes go: -o probes."};
    if (a.given("--size") && a.given("--budget"))
        return Error{"is chosen by --budget", "--size", "Leave one of them out."};
    if (auto ok = check_numbers(w, a); !ok) return ok;
    if (auto ok = check_placement(w, a); !ok) return ok;
    return check_boxes(w);
}

}  // namespace domelight::cli
