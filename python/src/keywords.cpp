#include "keywords.h"

#include <fmt/format.h>

#include <limits>

namespace domelight::python {
namespace {

/// A number of Python or NumPy as a double; nothing if it is none.
std::optional<double> number(nb::handle value) {
    if (PyBool_Check(value.ptr()) || PyUnicode_Check(value.ptr())) return std::nullopt;
    const double as_double = PyFloat_AsDouble(value.ptr());
    if (as_double == -1 && PyErr_Occurred()) {
        PyErr_Clear();
        return std::nullopt;
    }
    return as_double;
}

/// A whole number of Python or NumPy; nothing if it is none. One beyond `long long` is cut off there.
std::optional<long long> whole_number(nb::handle value) {
    if (PyBool_Check(value.ptr()) || !PyIndex_Check(value.ptr())) return std::nullopt;
    const nb::object index = nb::steal(PyNumber_Index(value.ptr()));
    if (!index.is_valid()) throw nb::python_error();
    int overflow = 0;
    const long long result = PyLong_AsLongLongAndOverflow(index.ptr(), &overflow);
    if (overflow) return overflow > 0 ? std::numeric_limits<long long>::max() : std::numeric_limits<long long>::min();
    return result;
}

}  // namespace

nb::object Keywords::find(const char* name) const {
    return words_.contains(name) ? nb::object(words_[name]) : nb::none();
}

void Keywords::wrong_type(const char* name, nb::handle value, const char* expected) {
    const nb::object raise = nb::module_::import_("domelight._errors").attr("wrong_type");
    raise(name, value, expected);
    throw nb::python_error();
}

void Keywords::read(const char* name, int& field) const {
    const nb::object value = find(name);
    if (value.is_none()) return;
    const auto number = whole_number(value);
    if (!number) wrong_type(name, value, "a whole number");
    constexpr long long most = std::numeric_limits<int>::max();
    if (*number > most || *number < -most)
        throw Failure({nb::str(value).c_str() + std::string(" is too large"), field_place(name), ""});
    field = int(*number);
}

void Keywords::read(const char* name, std::uint64_t& field) const {
    const nb::object value = find(name);
    if (value.is_none()) return;
    const auto number = whole_number(value);
    if (!number) wrong_type(name, value, "a whole number");
    if (*number < 0) throw Failure({nb::str(value).c_str() + std::string(" is negative"), field_place(name), ""});
    field = std::uint64_t(*number);
}

void Keywords::read(const char* name, double& field) const {
    const nb::object value = find(name);
    if (value.is_none()) return;
    const auto as_number = number(value);
    if (!as_number) wrong_type(name, value, "a number");
    field = *as_number;
}

void Keywords::read(const char* name, bool& field) const {
    const nb::object value = find(name);
    if (value.is_none()) return;
    const int truth = PyObject_IsTrue(value.ptr());
    if (truth < 0) throw nb::python_error();
    field = truth != 0;
}

void Keywords::read(const char* name, std::string& field) const {
    const nb::object value = find(name);
    if (value.is_none()) return;
    if (!PyUnicode_Check(value.ptr())) wrong_type(name, value, "a str");
    field = nb::cast<std::string>(value);
}

void Keywords::read(const char* name, std::vector<double>& field) const {
    const nb::object value = find(name);
    if (value.is_none()) return;
    if (PyUnicode_Check(value.ptr()) || !PySequence_Check(value.ptr()))
        wrong_type(name, value, "a sequence of numbers");
    field.clear();
    for (nb::handle item : value) {
        const auto as_number = number(item);
        if (!as_number) wrong_type(name, item, "a number");
        field.push_back(*as_number);
    }
}

void Keywords::read(const char* name, std::vector<std::string>& field) const {
    const nb::object value = find(name);
    if (value.is_none()) return;
    field.clear();
    if (PyUnicode_Check(value.ptr())) {  // one word alone
        field.push_back(nb::cast<std::string>(value));
        return;
    }
    if (!PySequence_Check(value.ptr())) wrong_type(name, value, "a str or a sequence of str");
    for (nb::handle item : value) {
        if (!PyUnicode_Check(item.ptr())) wrong_type(name, item, "a str");
        field.push_back(nb::cast<std::string>(item));
    }
}

void Keywords::read(const char* name, Mat3& field) const {
    const nb::object value = find(name);
    if (value.is_none()) return;
    std::vector<double> numbers;
    for (nb::handle row : value)
        for (nb::handle item : row) {
            const auto as_number = number(item);
            if (!as_number) wrong_type(name, item, "a number");
            numbers.push_back(*as_number);
        }
    if (numbers.size() != 9)
        throw Failure({std::to_string(numbers.size()) + " numbers, expected a 3 x 3 matrix", field_place(name), ""});
    for (std::size_t r = 0; r < 3; ++r) field.row[r] = {numbers[3 * r], numbers[3 * r + 1], numbers[3 * r + 2]};
}

void check_within(const char* keyword, double value, double low, double high) {
    if (!(value >= low && value <= high))
        throw Failure({fmt::format("{:g} is not from {:g} to {:g}", value, low, high), field_place(keyword), ""});
}

}  // namespace domelight::python
