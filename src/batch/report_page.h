#pragma once

namespace domelight {

/// The page of a batch's report, before and after the JSON document that it shows. It loads the pictures beside it and
/// nothing else.
extern const char* const k_report_head;
extern const char* const k_report_tail;

}  // namespace domelight
