#include "errors.h"

namespace domelight::python {
namespace {

void raise(const Error& error) {
    const nb::object make = nb::module_::import_("domelight._errors").attr("from_library");
    const nb::object exception = make(error.what, error.where, error.hint);
    PyErr_SetObject(reinterpret_cast<PyObject*>(Py_TYPE(exception.ptr())), exception.ptr());
}

}  // namespace

void register_errors() {
    nb::register_exception_translator([](const std::exception_ptr& thrown, void*) {
        try {
            std::rethrow_exception(thrown);
        } catch (const Failure& failure) {
            raise(failure.error());
        }
    });
}

}  // namespace domelight::python
