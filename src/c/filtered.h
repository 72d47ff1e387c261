#pragma once

#include "domelight/filtering/prefilter.h"

#include "c/border.h"

struct domelight_filtered {
    domelight::FilterResult result;
};
