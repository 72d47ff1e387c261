// domelight._core: what the Python package calls. Its functions take keywords as a dictionary; the functions that users
// see, with their signatures and documentation, are in the package.

#include "domelight/base/version.h"

#include "baking.h"
#include "comparing.h"
#include "converting.h"
#include "environment.h"
#include "errors.h"
#include "extraction.h"
#include "filtering.h"
#include "linear.h"
#include "pictures.h"
#include "sampling.h"


NB_MODULE(_core, module) {
    using namespace domelight::python;
    nb::set_leak_warnings(false);  // exceptions that a user keeps alive are no leaks
    register_errors();
    declare_environment(module);
    declare_filtering(module);
    declare_linear(module);
    declare_sampling(module);
    declare_baking(module);
    declare_comparing(module);
    declare_converting(module);
    declare_extraction(module);
    declare_pictures(module);
    module.def("version", [] { return std::string(domelight::version()); });
}
