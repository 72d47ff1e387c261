#include "domelight/sampling/distribution/distribution.h"
#include "domelight/sampling/distribution/alias.h"
#include "domelight/sampling/distribution/bilinear.h"
#include "domelight/sampling/distribution/binary.h"
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

std::string method_name(DistributionMethod method) {
    switch (method) {
        case DistributionMethod::linear:
            return "linear";
        case DistributionMethod::walk:
            return "walk";
        case DistributionMethod::binary:
            return "binary";
        case DistributionMethod::guided:
            return "guided";
        case DistributionMethod::alias:
            return "alias";
        case DistributionMethod::hierarchical:
            return "hierarchical";
        case DistributionMethod::bilinear:
            return "bilinear";
        case DistributionMethod::bilinear_plain:
            return "bilinear_plain";
    }
    return "";
}

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
