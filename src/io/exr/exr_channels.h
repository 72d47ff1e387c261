#pragma once

#include "domelight/base/result.h"

#include <optional>
#include <string>
#include <vector>

namespace domelight {

/// What the header of a part states.
struct ExrPart {
    std::string name;  ///< empty in a file of one part
    std::string view;  ///< empty: none is stated
    bool deep = false;
    std::vector<std::string> channels;
};

/// A channel of an OpenEXR file that is not deep.
struct ExrChannel {
    int part = 0;
    std::string name;   ///< within its part: "R", "direct.R"
    std::string layer;  ///< of the file: what stands before the last dot of `name`, after the part's name if there are
                        ///< several parts; empty: the unnamed layer
    std::string last;   ///< what stands after the last dot
    std::string full() const { return layer.empty() ? last : layer + "." + last; }
};

/// The channels that make up a picture.
struct ExrColour {
    enum class Kind {
        rgb,
        luminance,         ///< one channel for all three
        luminance_chroma,  ///< Y, RY and BY
        vector,            ///< X, Y and Z: numbers, not colours
    } kind = Kind::rgb;
    int part = 0;
    std::string layer;          ///< as in ExrChannel
    std::string names[3];       ///< within the part; luminance: the first; rgb: empty where there is none
    bool chosen_by_us = false;  ///< nobody named the layer, and there are others
};

/// The channels of an OpenEXR file, and which of them are the picture.
class ExrChannels {
  public:
    explicit ExrChannels(std::vector<ExrPart> parts);

    /// In the file's order.
    const std::vector<ExrChannel>& all() const { return all_; }
    /// By its full name; null where there is none.
    const ExrChannel* find(const std::string& full) const;
    /// Each layer once, in the file's order: "", "direct", "ViewLayer.Combined".
    std::vector<std::string> layers() const;

    /// The colour of the file (`layer` empty) or of one layer.
    ///
    /// Empty: the unnamed layer; else the one named rgba, rgb, beauty or combined, in any case and after any prefix;
    /// else the only one that has a colour. Layers that differ only in their view (left, right) are one: the first is
    /// taken.
    /// Not empty: a layer's name, the end of only one layer's name after a dot, a channel's name, or the name, the view
    /// or the number (from 0) of a part, whose colour is then chosen as that of a file is. Case counts only where two
    /// names differ in nothing else.
    ///
    /// A colour is R G B, r g b, or red green blue in any case, Y RY BY, or Y where there is no X (which makes a
    /// vector); of a layer that was asked for also X Y Z, or its only channel.
    /// Errors list the layers.
    Result<ExrColour> colour(const std::string& layer) const;

    /// The layers for a message: "(unnamed), direct, albedo".
    std::string layer_list() const;

  private:
    struct Layer {
        std::string name;
        int part = 0;
    };

    const ExrPart& part_of(const Layer& layer) const { return parts_[std::size_t(layer.part)]; }
    std::vector<Layer> layers_of(int part) const;
    std::vector<const ExrChannel*> channels_of(const Layer& layer) const;
    std::string without_view(const Layer& layer) const;
    std::optional<ExrColour> colour_in(const Layer& layer) const;
    std::optional<ExrColour> numbers_in(const Layer& layer) const;
    Result<ExrColour> choose(const std::vector<Layer>& among, const std::string& unnamed) const;
    Result<ExrColour> in_part(int part) const;
    Result<std::optional<Layer>> named_layer(const std::string& name) const;
    Result<std::optional<int>> named_part(const std::string& name) const;

    std::vector<ExrPart> parts_;
    std::vector<ExrChannel> all_;
};

}  // namespace domelight
