#pragma once

#include "domelight/filtering/prefilter.h"
#include "domelight/filtering/probe_filter.h"

#include "c/border.h"

struct domelight_filtered {
    domelight::FilterResult result;
};
struct domelight_probe_filter {
    domelight::ProbeFilter filter;
};
