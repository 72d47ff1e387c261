#include "domelight/study/strategy_study.h"

#include "domelight/base/parallel.h"
#include "domelight/base/random.h"
#include "domelight/filtering/reference.h"
#include "domelight/image/colour.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <functional>
#include <mutex>

namespace domelight {
namespace {

double thread_seconds() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

Surface surface_of(const StrategyStudyOptions& o) {
    return std::visit([&](const auto& brdf) { return make_surface(o.normal, o.view, brdf); }, o.brdf);
}

/// Mean and its standard error over independent runs.
struct Runs {
    Vec3d mean, error;
};
Runs repeat(int runs, int threads, const std::function<Vec3d(int run)>& one) {
    std::vector<Vec3d> values(runs);
    parallel_for(runs, threads, [&](int i) { values[i] = one(i); });
    Runs out;
    for (const Vec3d& v : values) out.mean += v / double(runs);
    for (const Vec3d& v : values) {
        const Vec3d d = v - out.mean;
        out.error += Vec3d{d.x * d.x, d.y * d.y, d.z * d.z} / (double(runs) * (runs - 1));
    }
    out.error = {std::sqrt(out.error.x), std::sqrt(out.error.y), std::sqrt(out.error.z)};
    return out;
}

/// Density per steradian (L in the local frame).
using Density = std::function<double(const Vec3f& L, const Vec3f& world)>;

/// A strategy together with the sampler that it draws from.
struct Contender {
    std::string name;
    Strategy strategy;
    const EnvironmentSampler* sampler;
    Density density;  ///< empty for strategies that have none
};

class Runner {
  public:
    Runner(const StrategyStudyOptions& options, const EnvironmentSampler& plain, const EnvironmentSampler& compensated)
        : options_(options),
          plain_(plain),
          compensated_(compensated),
          surface_(surface_of(options)),
          frame_(surface_.normal) {}

    void find_reference(StrategyStudy& study) const;
    std::vector<Contender> contenders() const;
    /// Adds the contender's results to the study. Returns false if `told` has cancelled the work.
    bool run(const Contender& contender, StrategyStudy& study, const std::function<bool(double)>& told) const;

  private:
    Estimate estimate(const Contender& c, int samples, int candidates, int run) const {
        EstimateOptions o;
        o.samples = samples;
        o.candidates = candidates;
        o.sequence = options_.sequence;
        // Run 0 has the seed itself: it is the estimate that a program with this seed gets.
        o.seed = run == 0 ? options_.seed : derive_key(options_.seed, std::uint64_t(run));
        return estimate_reflection(surface_, *c.sampler, c.strategy, o);
    }
    std::optional<double> variance(const Contender& c, const StrategyStudy& study) const;

    const StrategyStudyOptions& options_;
    const EnvironmentSampler &plain_, &compensated_;
    Surface surface_;
    Frame<double> frame_;
};

void Runner::find_reference(StrategyStudy& study) const {
    const auto* lambert = std::get_if<LambertBrdf>(&options_.brdf);
    if (lambert && plain_.distribution().continuous()) {
        const Vec3d direction = plain_.world_to_source() * surface_.normal;
        const Vec3d light =
            convolve_exactly(plain_.image(), ZonalKernel::cosine(), std::span(&direction, 1), options_.threads)[0];
        const Vec3d albedo(lambert->albedo);
        study.reference = {albedo.x * light.x, albedo.y * light.y, albedo.z * light.z};
        study.reference_method = "exact: the cosine integrated over the bilinear environment";
        return;
    }
    constexpr int runs = 16, samples = 1 << 17;
    const Runs r = repeat(runs, options_.threads, [&](int i) {
        EstimateOptions o{samples, Sequence::sobol, derive_key(0x5265666572656e63, std::uint64_t(i)), 8};
        return estimate_reflection(surface_, compensated_, Strategy::mis_balance, o).radiance;
    });
    study.reference = r.mean;
    study.reference_error = r.error;
    study.reference_method = fmt::format("MIS with compensation, {} Sobol runs of {} samples", runs, samples);
}

std::vector<Contender> Runner::contenders() const {
    const auto constant = [](double p) { return [p](const Vec3f&, const Vec3f&) { return p; }; };
    const Vec3f V(frame_.to_local(surface_.view));
    const auto plain = [this](Strategy strategy, Density density = {}) {
        return Contender{name_of(strategy), strategy, &plain_, std::move(density)};
    };
    std::vector<Contender> all{
        plain(Strategy::riemann),
        plain(Strategy::uniform, constant(0.5 / k_pi)),
        plain(Strategy::cosine, [](const Vec3f& L, const Vec3f&) { return L.z / k_pi; }),
        plain(Strategy::brdf,
              [this, V](const Vec3f& L, const Vec3f&) { return double(surface_.pdf_solid_angle(V, L)); }),
        plain(Strategy::environment,
              [this](const Vec3f&, const Vec3f& d) { return double(plain_.pdf_solid_angle(d)); }),
        plain(Strategy::mis_balance),
        plain(Strategy::mis_power),
        {k_compensated_mis, Strategy::mis_balance, &compensated_, {}},
        plain(Strategy::product)};
    // Efficiencies are relative to environment sampling.
    const auto& wanted = options_.strategies;
    std::erase_if(all, [&](const Contender& c) {
        return !wanted.empty() && c.strategy != Strategy::environment &&
               std::find(wanted.begin(), wanted.end(), c.name) == wanted.end();
    });
    return all;
}

/// Variance of one sample divided by the squared mean, of luminance.
std::optional<double> Runner::variance(const Contender& c, const StrategyStudy& study) const {
    if (!c.density || options_.sequence != Sequence::random) return std::nullopt;
    // The second moment is what a surface reflects whose BRDF is f · (f L cos θ / p).
    Surface squared = surface_;
    squared.evaluate = [&](const Vec3f& V, const Vec3f& L) {
        const Vec3f f = surface_.evaluate(V, L), d(frame_.to_world(Vec3d(L))), radiance = plain_.radiance(d);
        const double p = c.density(L, d), value = luminance(Vec3d{double(f.x) * radiance.x, double(f.y) * radiance.y,
                                                                  double(f.z) * radiance.z}) *
                                                  L.z;
        return value > 0 ? f * float(value / p) : Vec3f{};
    };
    const Runs r = repeat(16, options_.threads, [&](int i) {
        EstimateOptions o{1 << 14, Sequence::sobol, derive_key(0x566172, std::uint64_t(i)), 8};
        return estimate_reflection(squared, compensated_, Strategy::mis_balance, o).radiance;
    });
    const double mean = luminance(study.reference), relative = luminance(r.mean) / (mean * mean) - 1;
    return relative > 1e-6 ? relative : 0;
}

double slope_of(const std::vector<std::array<double, 2>>& curve) {
    double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (const auto& [x, y] : curve) {
        if (!(y > 0)) continue;
        const double lx = std::log(x), ly = std::log(y);
        n += 1, sx += lx, sy += ly, sxx += lx * lx, sxy += lx * ly;
    }
    return n >= 2 ? (n * sxy - sx * sy) / (n * sxx - sx * sx) : NAN;
}

/// The numbers of samples that are measured: up to `most` in factors of 4, or of 2 if `most` is small.
std::vector<int> steps(int most) {
    std::vector<int> n;
    const int factor = most >= 256 ? 4 : 2, least = most >= 256 ? 16 : 2;
    for (int k = most; k >= std::min(least, most); k /= factor) {
        n.push_back(k);
        if (k < factor) break;
    }
    std::reverse(n.begin(), n.end());
    return n;
}

bool Runner::run(const Contender& c, StrategyStudy& study, const std::function<bool(double)>& told) const {
    StrategyResult result;
    result.name = c.name;
    const double mean = luminance(study.reference);
    const std::vector<int> counts = steps(study.samples);
    double done = 0, all = 0;
    for (const int n : counts) all += std::min(4 * n, study.samples);
    for (const int n : counts) {
        // With few samples the error is decided by rare bright hits, so more runs are needed; these take little time.
        const int runs = c.strategy == Strategy::riemann ? 1 : study.runs * std::min(4, study.samples / n);
        std::vector<double> squares(runs), seconds(runs);
        std::vector<Estimate> first(1);
        parallel_for(runs, options_.threads, [&](int i) {
            const double start = thread_seconds();
            const Estimate e = estimate(c, n, study.candidates, i);
            seconds[i] = thread_seconds() - start;
            const double relative = luminance(e.radiance - study.reference) / mean;
            squares[i] = relative * relative;
            if (i == 0) first[0] = e;
        });
        double sum = 0, time = 0;
        for (int i = 0; i < runs; ++i) sum += squares[i], time += seconds[i];
        result.estimate = first[0];
        result.error = std::sqrt(sum / runs);
        result.cpu_seconds = time / runs;
        result.curve.push_back({double(first[0].samples), result.error});
        if (!told((done += std::min(4 * n, study.samples)) / all)) return false;
    }
    result.slope = slope_of(result.curve);
    result.variance = variance(c, study);
    study.strategies.push_back(std::move(result));
    return true;
}

/// Fills in the efficiencies, and how many samples each strategy needs for an error of 1 %.
void conclude(StrategyStudy& study, Sequence points) {
    const StrategyResult& yardstick = *study.find(name_of(Strategy::environment));
    const auto squared_error = [&](const StrategyResult& r) {
        const double expected = r.expected_error() * r.expected_error();
        // The product strategy averages candidates of the environment strategy, so light that the runs of one missed
        // was missed by both.
        if (r.name != name_of(Strategy::product) || !yardstick.missed()) return expected;
        const double scale = yardstick.expected_error() / yardstick.error;
        return expected * scale * scale;
    };
    const double unit = squared_error(yardstick) * yardstick.cpu_seconds;
    for (StrategyResult& r : study.strategies) {
        const double squared = squared_error(r);
        r.efficiency = squared > 0 ? unit / (squared * r.cpu_seconds) : INFINITY;
        const bool random = points == Sequence::random && r.name != name_of(Strategy::riemann);
        const double power = random ? 2 : r.slope < -0.25 ? -1 / r.slope : INFINITY;
        const double factor = std::sqrt(squared) / 0.01;
        r.for_one_percent = factor <= 1 && !std::isfinite(power) ? r.estimate.samples
                            : squared > 0 ? std::max(1.0, std::ceil(r.estimate.samples * std::pow(factor, power)))
                                          : 1;
    }
}

Result<void> check(const StrategyStudyOptions& options) {
    if (options.samples < 1) return Error{fmt::format("is {}, not at least 1", options.samples), "samples", ""};
    if (!(dot(options.normal, options.view) > 0))
        return Error{"lies below the surface", "view", "Its angle with the normal must be less than 90 degrees."};
    const auto& known = studied_strategies();
    for (const std::string& name : options.strategies)
        if (std::find(known.begin(), known.end(), name) == known.end())
            return Error{fmt::format("\"{}\" is none of {}", name, fmt::join(known, ", ")), "strategies", ""};
    return {};
}

}  // namespace

const StrategyResult* StrategyStudy::find(const std::string& name) const {
    const auto found =
        std::find_if(strategies.begin(), strategies.end(), [&](const StrategyResult& r) { return r.name == name; });
    return found == strategies.end() ? nullptr : &*found;
}

double StrategyStudy::efficiency_ratio(const std::string& name, const std::string& than) const {
    const StrategyResult *one = find(name), *other = find(than);
    return one && other ? one->efficiency / other->efficiency : NAN;
}

double StrategyStudy::product_gain_per_ray() const {
    const StrategyResult *product = find(name_of(Strategy::product)),
                         *environment = find(name_of(Strategy::environment));
    if (!product || !environment) return 0;
    const double kept = product->error * product->error * product->estimate.samples / candidates;
    const double drawn = environment->error * environment->error * environment->estimate.samples;
    return kept > 0 && drawn > 0 ? drawn / kept : 0;
}

const std::vector<std::string>& studied_strategies() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all = names_of<Strategy>();
        all.insert(std::find(all.begin(), all.end(), name_of(Strategy::product)), k_compensated_mis);
        return all;
    }();
    return names;
}

Result<StrategyStudy> study_strategies(const EnvironmentSampler& sampler, const StrategyStudyOptions& options) {
    if (auto ok = check(options); !ok) return ok.error();
    EnvironmentSamplerOptions with_compensation = sampler.options();
    with_compensation.compensate = true;
    auto compensated = EnvironmentSampler::build(sampler.image(), with_compensation, sampler.world_to_source());
    if (!compensated) return compensated.error();
    const Runner runner(options, sampler, *compensated);
    StrategyStudy study;
    study.samples = options.samples;
    study.runs = std::clamp((1 << 19) / study.samples, 8, 64);
    const auto tell = [&](double done) { return !options.progress || options.progress("estimate", done); };
    const Error cancelled{"cancelled", "", ""};
    if (!tell(0)) return cancelled;
    runner.find_reference(study);
    if (!(luminance(study.reference) > 0))
        return Error{"no light reaches the viewer from this surface", "", "Turn its normal towards the light."};
    const auto contenders = runner.contenders();
    for (std::size_t i = 0; i < contenders.size(); ++i) {
        const auto told = [&](double done) { return tell((double(i) + done) / double(contenders.size())); };
        if (!runner.run(contenders[i], study, told)) return cancelled;
    }
    conclude(study, options.sequence);
    return study;
}

}  // namespace domelight
