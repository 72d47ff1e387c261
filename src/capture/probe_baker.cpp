#include "domelight/capture/probe_baker.h"

#include "domelight/engines/engine.h"
#include "domelight/filtering/prefilter.h"
#include "domelight/filtering/probe_filter.h"

#include "base/field_place.h"

#include <fmt/core.h>

#include <algorithm>
#include <optional>

namespace domelight {

struct ProbeBaker::Impl {
    ProbeBakerOptions options;
    std::vector<float> roughness;
    FilterOptions filter;  ///< of every level but the first, and the irradiance
    /// What is computed once for all probes; none where the size is beyond its range.
    std::optional<ProbeFilter> prepared;

    Result<FilterResult> filtered(const Cubemap& cube) const {
        return prepared ? prepared->filter(cube) : prefilter(cube, filter);
    }
};

ProbeBaker::ProbeBaker() : impl_(std::make_unique<Impl>()) {}
ProbeBaker::~ProbeBaker() = default;
ProbeBaker::ProbeBaker(ProbeBaker&&) noexcept = default;
ProbeBaker& ProbeBaker::operator=(ProbeBaker&&) noexcept = default;

namespace {

/// Down to 4 x 4 texels.
int default_levels(int size) {
    int levels = 2;
    while (size >> levels >= 4) ++levels;
    return levels;
}

/// The largest whole part of a face that is at most 32.
int default_distance_size(int size) {
    int block = std::max(1, (size + 31) / 32);
    while (size % block != 0) ++block;
    return size / block;
}

ProbeBakerOptions with_defaults(ProbeBakerOptions options) {
    if (options.levels == 0) options.levels = default_levels(options.size);
    if (options.distance_size == -1) options.distance_size = default_distance_size(options.size);
    return options;
}

Result<void> check(const ProbeBakerOptions& o) {
    const struct {
        const char* field;
        double value, low, high;
    } ranges[] = {{"size", double(o.size), 8, 1024},
                  {"levels", double(o.levels), 2, 16},
                  {"irradiance_size", double(o.irradiance_size), 1, 256},
                  {"distance_size", double(o.distance_size), 0, 1024},
                  {"farthest", o.farthest, 1e-6, 1e9}};
    for (const auto& r : ranges)
        if (!(r.value >= r.low && r.value <= r.high))
            return Error{fmt::format("{:g} is not from {:g} to {:g}", r.value, r.low, r.high), field_place(r.field),
                         ""};
    if (o.size >> (o.levels - 1) < 1)
        return Error{fmt::format("{} levels are more than faces of {} texels have", o.levels, o.size),
                     field_place("levels"), ""};
    if (o.distance_size > 0 && o.size % o.distance_size != 0)
        return Error{fmt::format("{} texels do not divide the {} of a face", o.distance_size, o.size),
                     field_place("distance_size"), ""};
    return {};
}

/// The moments of the distances, of which those beyond `farthest` count as that, averaged over blocks of texels down to
/// `size`.
Cubemap moments(const CapturedCube& captured, float farthest, int size) {
    const int n = captured.depth.size(), block = n / size;
    Cubemap out(size, 2);
    const ImageView<const float> depth = captured.depth.strip(), coverage = captured.coverage.strip();
    for (int y = 0; y < 6 * n; ++y)
        for (int x = 0; x < n; ++x) {
            const float d = std::min(*depth.at(x, y), farthest), part = *coverage.at(x, y);
            float* p = out.strip().at(x / block, y / block);
            p[0] += part * d + (1 - part) * farthest;
            p[1] += part * d * d + (1 - part) * farthest * farthest;
        }
    for (float& v : out.pixels()) v /= float(block * block);
    return out;
}

}  // namespace

Result<void> check_baker_options(const ProbeBakerOptions& options) {
    return check(with_defaults(options));
}

std::uint64_t probe_bytes(const ProbeBakerOptions& given, Encoding encoding) {
    const ProbeBakerOptions o = with_defaults(given);
    const auto cube = [](int size) { return std::uint64_t(6) * std::uint64_t(size) * std::uint64_t(size); };
    std::uint64_t texels = cube(o.irradiance_size);
    for (int l = 0; l < o.levels; ++l) texels += cube(std::max(1, o.size >> l));
    // In probes.json a probe takes about a kilobyte.
    return texels * std::uint64_t(encoding_bytes(encoding)) +
           cube(o.distance_size) * std::uint64_t(encoding_bytes(Encoding::rg32f)) + 1000;
}

Result<int> size_for_budget(const ProbeBakerOptions& options, Encoding encoding, std::uint64_t bytes, int probes) {
    std::uint64_t needed = 0;
    for (const int size : {512, 256, 128, 64, 32, 16, 8}) {
        ProbeBakerOptions o = options;
        o.size = size;
        // Stated levels or distances may not go with every size.
        if (!check(with_defaults(o))) continue;
        needed = probe_bytes(o, encoding) * std::uint64_t(probes);
        if (needed <= bytes) return size;
    }
    return Error{fmt::format("{:.3g} MB are too few for {} probes, which take {:.3g} MB at least", double(bytes) / 1e6,
                             probes, double(needed) / 1e6),
                 field_place("budget"), "Fewer probes, or a larger budget, would do."};
}

Result<ProbeBaker> ProbeBaker::make(const ProbeBakerOptions& options) {
    ProbeBaker filter;
    Impl& impl = *filter.impl_;
    impl.options = with_defaults(options);
    const ProbeBakerOptions& o = impl.options;
    if (auto ok = check(o); !ok) return ok.error();
    const Engine& generic = engines().front();
    for (int l = 0; l < o.levels; ++l) {
        const double roughness = generic.roughness(l, o.levels, o.size);
        impl.roughness.push_back(float(roughness));
        if (l > 0) impl.filter.specular.push_back(glossy_level_spec(Lobe::ggx, o.size >> l, roughness));
    }
    impl.filter.irradiance_size = o.irradiance_size;
    impl.filter.sh_bands = 3;
    impl.filter.threads = 1;
    if (o.size >= 16 && o.size <= 256) {
        auto prepared = ProbeFilter::make(o.size, impl.filter);
        if (!prepared) return prepared.error();
        impl.prepared.emplace(*std::move(prepared));
    }
    return filter;
}

const ProbeBakerOptions& ProbeBaker::options() const {
    return impl_->options;
}
const std::vector<float>& ProbeBaker::roughness() const {
    return impl_->roughness;
}

Result<ProbeMaps> ProbeBaker::operator()(const CapturedCube& captured) const {
    auto filtered = impl_->filtered(captured.radiance);
    if (!filtered) return filtered.error();
    ProbeMaps maps;
    maps.specular.push_back(captured.radiance);
    for (FilteredMap& level : filtered->specular) maps.specular.push_back(std::move(level).cube());
    maps.irradiance_over_pi = std::move(filtered->irradiance_over_pi).cube();
    std::ranges::copy(filtered->sh, maps.harmonics.begin());
    if (impl_->options.distance_size > 0)
        maps.distance = moments(captured, impl_->options.farthest, impl_->options.distance_size);
    return maps;
}

}  // namespace domelight
