#include "domelight/sampling/environment_sampler.h"
#include "domelight/sampling/sequences.h"

#include "c/environment.h"

#include <array>
#include <cmath>
#include <span>

using namespace domelight;

struct domelight_sampler {
    EnvironmentSampler sampler;
};

namespace {

// A caller's pairs of numbers are read as points.
static_assert(sizeof(UnitPoint) == 2 * sizeof(std::uint32_t));

constexpr domelight_sampler_options k_options{};

Result<EnvironmentSamplerOptions> read_options(const domelight_sampler_options& given) {
    EnvironmentSamplerOptions options;
    const auto method = c::read_word(given.method, options.method, "method");
    if (!method) return method.error();
    const auto weight = c::read_word(given.weight, options.weight, "weight");
    if (!weight) return weight.error();
    if (!(given.uniform_share >= 0 && given.uniform_share <= 1))
        return Error{text(given.uniform_share, " is not from 0 to 1"), field_place("uniform_share"), ""};
    if (auto ok = c::check_threads(given.threads); !ok) return ok.error();
    options.method = *method;
    options.weight = *weight;
    options.uniform_share = given.uniform_share;
    options.compensate = given.compensate != 0;
    options.threads = given.threads;
    return options;
}

domelight_light_sample sample_of(const LightSample& s) {
    return {s.u,
            s.v,
            {s.direction.x, s.direction.y, s.direction.z},
            {s.radiance.x, s.radiance.y, s.radiance.z},
            s.pdf_solid_angle};
}

/// The caller's arrays as spans, a piece at a time. What the caller does not want is written to a piece of our own.
class Pieces {
  public:
    Pieces(const domelight_light_samples& samples, std::size_t count) : samples_(samples), count_(count) {
        const std::array<float*, 9> all{samples.u, samples.v, samples.x, samples.y,  samples.z,
                                        samples.r, samples.g, samples.b, samples.pdf};
        for (const float* array : all) complete_ &= array != nullptr;
        if (!complete_) scratch_.resize(all.size() * k_piece);
    }
    /// Calls visit(first, count, spans) for each piece.
    template <typename Visit>
    void each(const Visit& visit) {
        const std::size_t step = complete_ ? count_ : k_piece;
        for (std::size_t first = 0; first < count_; first += step) {
            const std::size_t n = std::min(step, count_ - first);
            int next = 0;
            const auto span = [&](float* array) {
                float* own = complete_ ? nullptr : scratch_.data() + k_piece * std::size_t(next);
                ++next;
                return std::span<float>(array ? array + first : own, n);
            };
            const auto& s = samples_;
            // The order of evaluation inside braces is that of writing.
            visit(first, n,
                  LightSampleSpans{span(s.u), span(s.v), span(s.x), span(s.y), span(s.z), span(s.r), span(s.g),
                                   span(s.b), span(s.pdf)});
        }
    }

  private:
    static constexpr std::size_t k_piece = 1024;
    domelight_light_samples samples_;
    std::size_t count_;
    bool complete_ = true;
    std::vector<float> scratch_;
};

Result<void> check_directions(const domelight_light_samples& s, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
        const float squared = s.x[i] * s.x[i] + s.y[i] * s.y[i] + s.z[i] * s.z[i];
        if (!(squared > 0) || !std::isfinite(squared))
            return Error{
                text("number ", std::int64_t(i), ", (", s.x[i], ", ", s.y[i], ", ", s.z[i], "), is not a direction"),
                field_place("samples"), ""};
    }
    return {};
}

}  // namespace

extern "C" {

void domelight_sampler_options_init_sized(domelight_sampler_options* options, size_t struct_size) {
    c::init_struct(options, struct_size, k_options);
}

domelight_error* domelight_sampler_build(const domelight_environment* environment,
                                         const domelight_sampler_options* options, domelight_sampler** sampler) {
    return c::guarded([&]() -> Result<void> {
        if (auto ok = c::check_given({{environment, "environment"}, {sampler, "sampler"}}); !ok) return ok;
        const auto given = c::read_struct(options, k_options);
        if (!given) return given.error();
        const auto wanted = read_options(*given);
        if (!wanted) return wanted.error();
        auto built = EnvironmentSampler::build(environment->environment, *wanted);
        if (!built) return built.error();
        return c::hand_out(sampler, *std::move(built));
    });
}

void domelight_sampler_free(domelight_sampler* sampler) {
    delete sampler;
}

domelight_error* domelight_sampler_sample(const domelight_sampler* sampler, uint32_t x, uint32_t y,
                                          domelight_light_sample* sample) {
    return c::guarded([&]() -> Result<void> {
        if (auto ok = c::check_given({{sampler, "sampler"}, {sample, "sample"}}); !ok) return ok;
        *sample = sample_of(sampler->sampler.sample({x, y}));
        return {};
    });
}

domelight_error* domelight_sampler_look_up(const domelight_sampler* sampler, const float direction[3],
                                           domelight_light_sample* sample) {
    return c::guarded([&]() -> Result<void> {
        if (auto ok = c::check_given({{sampler, "sampler"}, {direction, "direction"}, {sample, "sample"}}); !ok)
            return ok;
        const double wanted[3] = {direction[0], direction[1], direction[2]};
        const auto checked = c::read_direction(wanted);
        if (!checked) return checked.error();
        *sample = sample_of(sampler->sampler.look_up(Vec3f(*checked)));
        return {};
    });
}

domelight_error* domelight_sampler_sample_many(const domelight_sampler* sampler, const uint32_t* points, size_t count,
                                               const domelight_light_samples* samples) {
    return c::guarded([&]() -> Result<void> {
        if (auto ok = c::check_given({{sampler, "sampler"}, {samples, "samples"}}); !ok) return ok;
        if (count == 0) return {};
        if (auto ok = c::check_given({{points, "points"}}); !ok) return ok;
        const auto* all = reinterpret_cast<const UnitPoint*>(points);
        Pieces(*samples, count).each([&](std::size_t first, std::size_t n, const LightSampleSpans& out) {
            sampler->sampler.sample(std::span(all + first, n), out);
        });
        return {};
    });
}

domelight_error* domelight_sampler_look_up_many(const domelight_sampler* sampler, size_t count,
                                                const domelight_light_samples* samples) {
    return c::guarded([&]() -> Result<void> {
        if (auto ok = c::check_given({{sampler, "sampler"}, {samples, "samples"}}); !ok) return ok;
        if (count == 0) return {};
        if (auto ok = c::check_given({{samples->x, "x"}, {samples->y, "y"}, {samples->z, "z"}}); !ok) return ok;
        if (auto ok = check_directions(*samples, count); !ok) return ok;
        Pieces(*samples, count).each([&](std::size_t, std::size_t, const LightSampleSpans& out) {
            sampler->sampler.look_up(out);
        });
        return {};
    });
}

domelight_error* domelight_sequence_points(const char* sequence, uint64_t seed, uint32_t first, size_t count,
                                           uint32_t total, uint32_t* points) {
    return c::guarded([&]() -> Result<void> {
        const auto chosen = c::read_word(sequence, Sequence::sobol, "sequence");
        if (!chosen) return chosen.error();
        if (total < 1 || total > (std::uint32_t(1) << 31))
            return Error{text(std::int64_t(total), " is not from 1 to 2^31"), field_place("total"), ""};
        if (count == 0) return {};
        if (auto ok = c::check_given({{points, "points"}}); !ok) return ok;
        for (std::size_t i = 0; i < count; ++i) {
            const UnitPoint point = unit_point(*chosen, seed, first + std::uint32_t(i), total);
            *points++ = point.x, *points++ = point.y;
        }
        return {};
    });
}

}  // extern "C"
