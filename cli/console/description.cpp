#include "cli/console/description.h"

#include <cassert>

namespace domelight::cli {
namespace {

DescriptionCollector* g_current = nullptr;

}  // namespace

DescriptionCollector::DescriptionCollector() {
    assert(!g_current);
    g_current = this;
}

DescriptionCollector::~DescriptionCollector() {
    g_current = nullptr;
}

DescriptionCollector* DescriptionCollector::current() {
    return g_current;
}

}  // namespace domelight::cli
