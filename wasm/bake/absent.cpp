// What the options of domelight_bake() cannot ask for, and its module therefore leaves out.

#include "domelight/compare/read_error.h"
#include "domelight/filtering/reference.h"

namespace domelight {

Result<ReadErrors> measure_as_read(const ReadChain&, const Environment&, const ReadErrorOptions&) {
    return Error{"what shaders read is not measured by the WebAssembly module", "", ""};
}
Result<FilterResult> prefilter_reference(ImageView<const float>, const FilterOptions&, const ReferenceOptions&) {
    return Error{"the reference methods are not in the WebAssembly module", "", ""};
}

}  // namespace domelight
