#include "io/exr/exr_channels.h"

#include "domelight/io/file/file_extension.h"

#include "io/file/printable.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <utility>

namespace domelight {

namespace {

/// What a layer or a channel is called in a message.
std::string shown(const std::string& name) {
    return name.empty() ? "(unnamed)" : printable(name);
}

/// Names side by side, as many as are readable.
std::string listed(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) {
        if (text.size() > 300) return text + ", ...";
        text += (text.empty() ? "" : ", ") + shown(name);
    }
    return text;
}

/// The layer of a channel: what stands before its last dot, after the name of the part (empty in a file of one part)
/// unless it says that itself.
std::string layer_of(const std::string& part, const std::string& prefix) {
    if (part.empty() || prefix == part || prefix.starts_with(part + ".")) return prefix;
    return prefix.empty() ? part : part + "." + prefix;
}

/// What stands after the last dot.
std::string last_word(const std::string& name) {
    return name.substr(name.rfind('.') + 1);
}

/// Names for what a renderer calls the picture itself, the most telling first.
constexpr std::string_view k_picture_names[] = {"rgba", "rgb", "beauty", "combined"};

}  // namespace

ExrChannels::ExrChannels(std::vector<ExrPart> parts) : parts_(std::move(parts)) {
    for (int p = 0; p < int(parts_.size()); ++p) {
        const ExrPart& part = parts_[std::size_t(p)];
        if (part.deep) continue;
        for (const std::string& name : part.channels) {
            const auto dot = name.rfind('.');
            const std::string prefix = dot == std::string::npos ? "" : name.substr(0, dot);
            all_.push_back({p, name, layer_of(part.name, prefix), last_word(name)});
        }
    }
}

const ExrChannel* ExrChannels::find(const std::string& full) const {
    const auto found = std::find_if(all_.begin(), all_.end(), [&](const ExrChannel& c) { return c.full() == full; });
    return found == all_.end() ? nullptr : &*found;
}

std::vector<ExrChannels::Layer> ExrChannels::layers_of(int part) const {
    std::vector<Layer> found;
    for (const ExrChannel& c : all_) {
        const auto same = [&](const Layer& l) { return l.name == c.layer && l.part == c.part; };
        if ((part < 0 || c.part == part) && std::none_of(found.begin(), found.end(), same))
            found.push_back({c.layer, c.part});
    }
    return found;
}

std::vector<std::string> ExrChannels::layers() const {
    std::vector<std::string> names;
    for (const Layer& layer : layers_of(-1))
        if (std::find(names.begin(), names.end(), layer.name) == names.end()) names.push_back(layer.name);
    return names;
}

std::string ExrChannels::layer_list() const {
    return listed(layers());
}

std::vector<const ExrChannel*> ExrChannels::channels_of(const Layer& layer) const {
    std::vector<const ExrChannel*> found;
    for (const ExrChannel& c : all_)
        if (c.part == layer.part && c.layer == layer.name) found.push_back(&c);
    return found;
}

namespace {

/// The channels with these last words, in any case; all of them, or nothing.
std::optional<std::array<std::string, 3>> three_of(const std::vector<const ExrChannel*>& channels,
                                                   const std::array<std::string_view, 3>& words) {
    std::array<std::string, 3> names;
    for (std::size_t i = 0; i < 3; ++i)
        for (const ExrChannel* c : channels)
            if (lower_case(c->last) == words[i]) names[i] = c->name;
    if (std::any_of(names.begin(), names.end(), [](const std::string& n) { return n.empty(); })) return std::nullopt;
    return names;
}

/// The name of the channel with this last word; empty: there is none.
std::string one_of(const std::vector<const ExrChannel*>& channels, std::string_view word) {
    for (const ExrChannel* c : channels)
        if (c->last == word) return c->name;
    return "";
}

}  // namespace

std::optional<ExrColour> ExrChannels::colour_in(const Layer& layer) const {
    using Kind = ExrColour::Kind;
    const auto channels = channels_of(layer);
    const std::string r = one_of(channels, "R"), g = one_of(channels, "G"), b = one_of(channels, "B");
    if (!r.empty() || !g.empty() || !b.empty()) return ExrColour{Kind::rgb, layer.part, layer.name, {r, g, b}};
    for (const auto& words : {std::array<std::string_view, 3>{"r", "g", "b"}, {"red", "green", "blue"}})
        if (const auto names = three_of(channels, words))
            return ExrColour{Kind::rgb, layer.part, layer.name, {(*names)[0], (*names)[1], (*names)[2]}};
    const std::string y = one_of(channels, "Y");
    if (y.empty() || !one_of(channels, "X").empty()) return std::nullopt;
    const bool chroma = !one_of(channels, "RY").empty() && !one_of(channels, "BY").empty();
    return ExrColour{chroma ? Kind::luminance_chroma : Kind::luminance, layer.part, layer.name, {y, "", ""}};
}

std::optional<ExrColour> ExrChannels::numbers_in(const Layer& layer) const {
    using Kind = ExrColour::Kind;
    const auto channels = channels_of(layer);
    if (const auto names = three_of(channels, {"x", "y", "z"}))
        return ExrColour{Kind::vector, layer.part, layer.name, {(*names)[0], (*names)[1], (*names)[2]}};
    if (channels.size() == 1) return ExrColour{Kind::luminance, layer.part, layer.name, {channels[0]->name, "", ""}};
    return std::nullopt;
}

/// A layer's name without the word that says its view, which may be its first or its last.
std::string ExrChannels::without_view(const Layer& layer) const {
    const auto is_view = [&](const std::string& word) {
        const std::string low = lower_case(word);
        return low == "left" || low == "right" || (!word.empty() && word == part_of(layer).view);
    };
    if (is_view(layer.name)) return "";
    const auto first = layer.name.find('.'), last = layer.name.rfind('.');
    if (last == std::string::npos) return layer.name;
    if (is_view(layer.name.substr(last + 1))) return layer.name.substr(0, last);
    if (is_view(layer.name.substr(0, first))) return layer.name.substr(first + 1);
    return layer.name;
}

Result<ExrColour> ExrChannels::choose(const std::vector<Layer>& among, const std::string& unnamed) const {
    std::vector<Layer> coloured, rgb;
    for (const Layer& layer : among)
        if (const auto colour = colour_in(layer)) {
            coloured.push_back(layer);
            if (colour->kind == ExrColour::Kind::rgb) rgb.push_back(layer);
        }
    if (coloured.empty()) {
        std::vector<std::string> names;
        for (const Layer& layer : among)
            for (const ExrChannel* c : channels_of(layer)) names.push_back(c->full());
        return Error{fmt::format("no colour channels (R, G, B or Y) among: {}", names.empty() ? "none" : listed(names)),
                     "", "A layer or a channel may be named: `layer`."};
    }
    const auto the_one = [&](const std::vector<Layer>& layers) -> std::optional<ExrColour> {
        if (layers.empty()) return std::nullopt;
        for (const Layer& other : layers)
            if (without_view(other) != without_view(layers[0])) return std::nullopt;
        auto colour = colour_in(layers[0]);
        colour->chosen_by_us = among.size() > 1 && layers[0].name != unnamed;
        return colour;
    };
    const auto called = [&](auto is_it) {
        std::vector<Layer> found;
        std::copy_if(coloured.begin(), coloured.end(), std::back_inserter(found), is_it);
        return found;
    };
    if (const auto found = the_one(called([&](const Layer& l) { return l.name == unnamed; }))) return *found;
    if (const auto found = the_one(called([&](const Layer& l) { return without_view(l) == unnamed; }))) return *found;
    for (const std::string_view name : k_picture_names) {
        const auto layers = called([&](const Layer& l) { return lower_case(last_word(without_view(l))) == name; });
        if (const auto found = the_one(layers)) return *found;
        if (!layers.empty()) break;
    }
    if (const auto found = the_one(rgb.empty() ? coloured : rgb)) return *found;
    std::vector<std::string> names;
    for (const Layer& layer : coloured) names.push_back(layer.name);
    return Error{fmt::format("several layers have a colour, and none is named as the picture: {}", listed(names)), "",
                 "Say which: `layer`."};
}

Result<ExrColour> ExrChannels::in_part(int part) const {
    const ExrPart& p = parts_[std::size_t(part)];
    if (p.deep)
        return Error{fmt::format("part {} is deep, and deep images cannot be read", shown(p.name)), "",
                     "Flatten it first."};
    const auto layers = layers_of(part);
    if (layers.size() == 1)
        if (const auto numbers = numbers_in(layers[0]); numbers && !colour_in(layers[0])) return *numbers;
    return choose(layers, p.name);
}

Result<std::optional<ExrChannels::Layer>> ExrChannels::named_layer(const std::string& name) const {
    const std::string low = lower_case(name);
    const auto all = layers_of(-1);
    const auto ends_in = [](const std::string& whole, const std::string& end) { return whole.ends_with("." + end); };
    for (const bool exact : {true, false})
        for (const bool whole : {true, false}) {
            std::vector<Layer> found;
            for (const Layer& layer : all) {
                const std::string& is = exact ? layer.name : lower_case(layer.name);
                const std::string& wanted = exact ? name : low;
                if (whole ? is == wanted : ends_in(is, wanted)) found.push_back(layer);
            }
            if (found.size() == 1) return std::optional(found[0]);
            if (found.size() > 1 && !(whole && exact))
                return Error{fmt::format("more than one layer {}", printable(name)), "",
                             "The file has: " + layer_list() + "."};
            if (found.size() > 1) return std::optional(found[0]);  // parts of one name
        }
    return std::optional<Layer>();
}

Result<std::optional<int>> ExrChannels::named_part(const std::string& name) const {
    const auto part = [&](auto is_it) -> std::optional<int> {
        const auto found = std::find_if(parts_.begin(), parts_.end(), is_it);
        if (found == parts_.end()) return std::nullopt;
        return int(found - parts_.begin());
    };
    const std::string low = lower_case(name);
    if (const auto found = part([&](const ExrPart& p) { return !p.name.empty() && lower_case(p.name) == low; }))
        return std::optional(found);
    if (const auto found = part([&](const ExrPart& p) { return !p.view.empty() && lower_case(p.view) == low; }))
        return std::optional(found);
    if (name.size() > 4 || !std::all_of(name.begin(), name.end(), [](char c) { return c >= '0' && c <= '9'; }))
        return std::optional<int>();
    const int number = std::stoi(name);
    if (number < int(parts_.size())) return std::optional(number);
    return Error{fmt::format("no part {}: the file has {}, and the first is 0", number, parts_.size()), "", ""};
}

Result<ExrColour> ExrChannels::colour(const std::string& name) const {
    if (name.empty()) {
        const bool deep = std::any_of(parts_.begin(), parts_.end(), [](const ExrPart& p) { return p.deep; });
        auto chosen = choose(layers_of(-1), "");
        if (!chosen && deep && all_.empty()) return Error{"deep images cannot be read", "", "Flatten it first."};
        if (!chosen && deep)
            return Error{chosen.error().what + "; deep parts cannot be read", chosen.error().where,
                         chosen.error().hint};
        return chosen;
    }
    const auto layer = named_layer(name);
    if (!layer) return layer.error();
    if (*layer) {
        if (const auto colour = colour_in(**layer)) return *colour;
        if (const auto numbers = numbers_in(**layer)) return *numbers;
    }
    if (const ExrChannel* channel = find(name))
        return ExrColour{ExrColour::Kind::luminance, channel->part, channel->layer, {channel->name, "", ""}};
    const auto part = named_part(name);
    if (!part) return part.error();
    if (*part) return in_part(**part);
    if (!*layer) return Error{fmt::format("no layer {}", printable(name)), "", "The file has: " + layer_list() + "."};
    std::vector<std::string> own;
    for (const ExrChannel* c : channels_of(**layer)) own.push_back(c->full());
    return Error{fmt::format("layer {} has no colour among: {}", shown((*layer)->name), listed(own)), "",
                 "Name a layer or a channel; the file's layers: " + layer_list() + "."};
}

}  // namespace domelight
