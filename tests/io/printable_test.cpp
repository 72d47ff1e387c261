#include "io/file/printable.h"

#include "test.h"

using namespace domelight;

TEST_CASE("escaped: what a terminal would act on is written out, everything else stays") {
    CHECK(escaped("studio café 光 👩‍🚀.hdr") == "studio café 光 👩‍🚀.hdr");
    CHECK(escaped("\x1b]0;title\x07\x1b[31mred\r\nerror: \t\x7f") ==
          "\\x1b]0;title\\x07\\x1b[31mred\\r\\nerror: \\t\\x7f");
    CHECK(escaped("\u202eevil\u2066\u200f\u2028\ufeff\u009b") == "\\u202eevil\\u2066\\u200f\\u2028\\ufeff\\u009b");
    CHECK(escaped("\U000e0041") == "\\U000e0041");
    CHECK(escaped(std::string("a\0b", 3)) == "a\\x00b");
    CHECK(escaped(escaped("\x1b")) == escaped("\x1b"));
}

TEST_CASE("escaped: bytes that are not UTF-8 are written out one by one") {
    CHECK(escaped("\xff\xfe") == "\\xff\\xfe");
    CHECK(escaped("\xc3") == "\\xc3");                             // cut off
    CHECK(escaped("\xc0\xaf") == "\\xc0\\xaf");                    // a longer form of '/'
    CHECK(escaped("\xe0\x80\xaf") == "\\xe0\\x80\\xaf");           // likewise
    CHECK(escaped("\xed\xa0\x80") == "\\xed\\xa0\\x80");           // half of a surrogate pair
    CHECK(escaped("\xf4\x90\x80\x80") == "\\xf4\\x90\\x80\\x80");  // beyond U+10FFFF
    CHECK(escaped("\xe2\x80z") == "\\xe2\\x80z");
}

TEST_CASE("printable: as many characters as asked for, whole ones") {
    CHECK(printable("日本語", 2) == "日本");
    CHECK(printable("\n\n\n", 2) == "\\n\\n");
    CHECK(printable(std::string(100, 'x')).size() == 40);
}

TEST_CASE("escaped_json: the same document, without characters that a terminal acts on") {
    CHECK(escaped_json("{\n  \"é\": \"\u202e\u009b\x7f\"\n}") == "{\n  \"é\": \"\\u202e\\u009b\\u007f\"\n}");
    CHECK(escaped_json("\"\U000e0041\"") == "\"\\udb40\\udc41\"");
}
