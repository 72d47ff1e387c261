#include "domelight/sampling/distribution/alias.h"
#include "domelight/sampling/distribution/bilinear.h"
#include "domelight/sampling/distribution/binary.h"
#include "domelight/sampling/distribution/distribution.h"
#include "domelight/sampling/distribution/guided.h"
#include "domelight/sampling/distribution/hierarchical.h"
#include "domelight/sampling/distribution/plain.h"

namespace domelight {

namespace {

template <typename T>
Result<std::unique_ptr<Distribution2D>> boxed(Result<T> distribution) {
    if (!distribution) return distribution.error();
    return std::unique_ptr<Distribution2D>(std::make_unique<T>(std::move(*distribution)));
}

}  // namespace

Result<std::unique_ptr<Distribution2D>> make_distribution(const Weights& weights, DistributionMethod method,
                                                          int threads) {
    switch (method) {
        case DistributionMethod::linear:
            return boxed(PlainDistribution2D::build(weights, PlainDistribution2D::Search::linear));
        case DistributionMethod::walk:
            return boxed(PlainDistribution2D::build(weights, PlainDistribution2D::Search::walk));
        case DistributionMethod::binary:
            return boxed(BinaryDistribution::build(weights, threads));
        case DistributionMethod::guided:
            return boxed(GuidedDistribution::build(weights, threads));
        case DistributionMethod::alias:
            return boxed(AliasDistribution::build(weights, threads));
        case DistributionMethod::hierarchical:
            return boxed(HierarchicalDistribution::build(weights, threads));
        case DistributionMethod::bilinear:
            return boxed(BilinearDistribution::build(weights, threads));
        case DistributionMethod::bilinear_plain:
            return boxed(PlainBilinearDistribution::build(weights));
    }
    return Error{"unknown method", "", ""};
}

}  // namespace domelight
