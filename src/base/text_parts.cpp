#include "base/text.h"

namespace domelight {

void TextPart::append_to(std::string& text) const {
    switch (kind_) {
        case Kind::words:
            text += words_;
            return;
        case Kind::number:
            text += decimal(number_);
            return;
        case Kind::single:
            text += decimal(float(number_));
            return;
        case Kind::whole:
            text += decimal(whole_);
            return;
    }
}

std::string join_text(std::initializer_list<TextPart> parts) {
    std::string text;
    for (const TextPart& part : parts) part.append_to(text);
    return text;
}

}  // namespace domelight
