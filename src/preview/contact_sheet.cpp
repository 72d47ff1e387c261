#include "domelight/base/parallel.h"
#include "domelight/filtering/harmonic/spherical_harmonics.h"
#include "domelight/preview/preview.h"
#include "domelight/projection/projection.h"

#include "image/draw.h"
#include "preview/agx_display.h"
#include "preview/dark_page.h"
#include "preview/preview_map.h"
#include "preview/tonemap.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace domelight {
namespace {

constexpr Colour8 k_edge{52, 54, 60};
constexpr int k_line = 20;  // pixels, from one line of small text to the next
constexpr double k_key = 0.18;
constexpr double k_smooth_alpha = 0.03;  // lobes wider than this have no detail as fine as the pixels of the chrome
                                         // balls

/// A picture on the sheet, drawn row by row (`row` counts from the top of `where`), so that threads can share it.
struct Panel {
    Rect where;
    std::function<void(ImageView<std::uint8_t>, int row)> draw;
};

struct Text {
    int x, baseline;
    std::string text;
    FontSize size;
    Colour8 colour;
    Align align = Align::left;
};

std::string number(double v) {
    return fmt::format("{:.3g}", v);
}

/// A ball of some diameter under an orthographic view along -Z: the lookups of each of its pixels. Computed once for
/// all maps of a layout.
struct Ball {
    bool cube, chrome;
    int size, samples;             ///< samples^2 a pixel
    std::vector<MapPlace> places;  ///< samples^2 for each pixel of the square, row by row; unused outside the disc
    std::vector<float> opacity;    ///< of each pixel
};

Ball make_ball(const PreviewMap& map, int size, bool chrome, int samples, int threads) {
    Ball ball{map.is_cube(), chrome, size, samples, {}, {}};
    const int per_pixel = samples * samples;
    ball.places.resize(std::size_t(size) * std::size_t(size) * std::size_t(per_pixel));
    ball.opacity.resize(std::size_t(size) * std::size_t(size));
    const float radius = 0.5f * float(size) - 0.5f, centre = 0.5f * float(size), step = 1 / float(samples);
    parallel_ranges(size, 16, threads, [&](int begin, int end) {
        for (int row = begin; row < end; ++row)
            for (int i = 0; i < size; ++i) {
                const float px = float(i) + 0.5f - centre, py = float(row) + 0.5f - centre;
                const std::size_t pixel = std::size_t(row) * std::size_t(size) + std::size_t(i);
                ball.opacity[pixel] = std::clamp(radius - std::sqrt(px * px + py * py) + 0.5f, 0.0f, 1.0f);
                if (ball.opacity[pixel] == 0) continue;
                for (int k = 0; k < per_pixel; ++k) {
                    const float dx = (float(k % samples) + 0.5f) * step, dy = (float(k / samples) + 0.5f) * step;
                    Vec3f n{(float(i) + dx - centre) / radius, (centre - float(row) - dy) / radius, 0};
                    const float r2 = n.x * n.x + n.y * n.y;
                    if (r2 > 0.9999f) n *= (0.99995f / std::sqrt(r2));
                    n.z = std::sqrt(std::max(0.0f, 1 - n.x * n.x - n.y * n.y));
                    // Towards the viewer is +Z: r = 2 (n.z) n - z.
                    const Vec3f d = chrome ? Vec3f{2 * n.z * n.x, 2 * n.z * n.y, 2 * n.z * n.z - 1} : n;
                    ball.places[pixel * std::size_t(per_pixel) + std::size_t(k)] = map.place(d);
                }
            }
    });
    return ball;
}

/// E / pi of radiance coefficients as a cube. Negative lobes are kept; bands from the 17th on are too fine for the
/// sheet.
FilteredMap irradiance_picture(std::span<const Vec3d> radiance) {
    const std::vector<Vec3d> sh = sh_irradiance_over_pi(radiance.first(std::min<std::size_t>(radiance.size(), 256)));
    const int n = sh.size() > 25 ? 64 : 32;
    FilteredMap picture = Cubemap(n);
    for (int y = 0; y < picture.image.height(); ++y)
        for (int x = 0; x < n; ++x) {
            const Vec3d v = sh_evaluate(sh, map_direction(Layout::cube, n, n, x, y));
            float* p = picture.image.at(x, y);
            p[0] = float(v.x);
            p[1] = float(v.y);
            p[2] = float(v.z);
        }
    return picture;
}

/// Packed colours to pixels.
void store(std::span<const std::uint32_t> colours, std::uint8_t* pixel) {
    for (const std::uint32_t colour : colours)
        for (int c = 0; c < 3; ++c) *pixel++ = std::uint8_t(colour >> (8 * c));
}

/// Lays the sheet out from the top down, collecting panels and texts, and draws them at the end.
class Sheet {
  public:
    explicit Sheet(const PreviewInput& input);
    Image<std::uint8_t> draw() const;

  private:
    void header();
    void environment_row();
    void level_grid(const std::vector<PreviewLevel>& levels, const std::vector<PreviewMap>& maps, const char* name,
                    bool with_table);
    void level_caption(int x, int y, int width, const PreviewLevel& level, const std::string& name);
    void footer();

    // Each draws a picture with its top left corner at (x, y).
    void latlong_panel(int x, int y, int width, const PreviewMap& map);
    void cross_panel(int x, int y, int width, const PreviewMap& map);
    void ball_panel(int x, int y, int size, const PreviewMap& map, bool chrome, int samples);
    std::shared_ptr<const Ball> ball(bool cube, int size, bool chrome, int samples);
    void brdf_panel(int x, int y, int size);
    void brdf_caption(int x, int y, int width);
    void axis_names(int x, int y, int width);
    void text(int x, int baseline, std::string s, Colour8 colour = k_text, Align align = Align::left,
              FontSize size = FontSize::small) {
        texts_.push_back({x, baseline, std::move(s), size, colour, align});
    }
    /// Two lines below a picture: its name and its kind.
    void caption(int x, int y, int width, const std::string& name, const std::string& detail);
    double sh_difference() const;

    const PreviewInput& in_;
    int width_, y_ = 0;
    double log_average_ = 0;
    double sh_difference_ = 0;
    AgxDisplay look_{1};
    PreviewMap environment_, irradiance_, sh_;
    std::vector<PreviewMap> levels_, sheen_;
    std::vector<std::shared_ptr<const Ball>> balls_;
    std::vector<Panel> panels_;
    std::vector<Text> texts_;
};

Sheet::Sheet(const PreviewInput& input) : in_(input), width_(std::max(input.width, 800)) {
    levels_.resize(in_.specular.size());
    sheen_.resize(in_.sheen.size());
    const int s = (width_ - 2 * k_margin - 60) / 5;
    // The maps that the panels look up, reduced first, each by itself.
    const std::size_t levels = levels_.size();
    parallel_for(int(levels + sheen_.size()) + 3, in_.threads, [&](int i) {
        if (i == 0) {
            if (in_.environment.data) environment_ = PreviewMap(in_.environment, (3 * s + 20) / 4, in_.world_to_source);
        } else if (i == 1) {
            if (in_.irradiance_over_pi) irradiance_ = PreviewMap(*in_.irradiance_over_pi, 64);
        } else if (i == 2) {
            if (in_.sh.empty()) return;
            sh_ = PreviewMap(irradiance_picture(in_.sh), 128);
        } else if (const auto l = std::size_t(i - 3); l < levels) {
            levels_[l] = PreviewMap(*in_.specular[l].map, 128);
        } else {
            sheen_[l - levels] = PreviewMap(*in_.sheen[l - levels].map, 128);
        }
    });
    // The exposure: from the source, else from its mirror-sharp level.
    if (in_.environment.data) {
        log_average_ = log_average_luminance(in_.environment);
    } else if (!levels_.empty()) {
        ImageF picture(256, 128, 3);
        for (int y = 0; y < 128; ++y)
            for (int x = 0; x < 256; ++x) {
                const Vec3f v = levels_[0].sample(Vec3f(latlong_direction({(x + 0.5) / 256, (y + 0.5) / 128})));
                const float rgb[3] = {v.x, v.y, v.z};
                std::copy(rgb, rgb + 3, picture.at(x, y));
            }
        log_average_ = log_average_luminance(picture.view());
    }
    const double automatic = log_average_ > 0 ? std::log2(k_key / log_average_) : 0;
    const double ev = std::clamp(in_.exposure_ev.value_or(automatic), -60.0, 60.0);
    look_ = AgxDisplay(float(std::exp2(ev)));
    if (!sh_.empty() && !irradiance_.empty()) sh_difference_ = sh_difference();
    // From here on the maps are only displayed.
    std::vector<PreviewMap*> maps{&environment_, &irradiance_, &sh_};
    for (PreviewMap& level : levels_) maps.push_back(&level);
    for (PreviewMap& level : sheen_) maps.push_back(&level);
    parallel_for(int(maps.size()), in_.threads, [&](int i) {
        maps[std::size_t(i)]->transform([&](const Texel4& radiance) { return look_.primaries(radiance); });
    });
    header();
    environment_row();
    level_grid(in_.specular, levels_, "level", in_.brdf.data != nullptr);
    level_grid(in_.sheen, sheen_, "sheen level", false);
    footer();
}

void Sheet::header() {
    const int right = width_ - k_margin;
    y_ = k_margin;
    const std::string exposure = fmt::format("exposure {:+.2f} EV", std::log2(look_.exposure()));
    const std::string reason = in_.exposure_ev ? std::string("as asked for")
                               : log_average_ > 0
                                   ? fmt::format("log-average luminance {} to {}", number(log_average_), k_key)
                                   : std::string("black environment");
    text(right, y_ + 20, exposure + " (" + reason + ")", k_text, Align::right);
    text(right, y_ + 46, "tone map AgX (punchy), sRGB", k_quiet, Align::right);
    const int room =
        width_ - 2 * k_margin - k_gap - std::max(text_width(exposure + " (" + reason + ")", FontSize::small), 280);
    text(k_margin, y_ + 20, fit_text(in_.title.empty() ? "environment" : in_.title, FontSize::large, room), k_bright,
         Align::left, FontSize::large);
    text(k_margin, y_ + 46, fit_text(in_.subtitle, FontSize::small, room), k_quiet);
    y_ += 68;
}

void Sheet::caption(int x, int y, int width, const std::string& name, const std::string& detail) {
    text(x, y + 18, fit_text(name, FontSize::small, width), k_text);
    text(x, y + 18 + k_line, fit_text(detail, FontSize::small, width), k_quiet);
}

/// RMS over the sphere of the harmonics' difference from the exact irradiance, over the irradiance's RMS.
double Sheet::sh_difference() const {
    double error = 0, truth = 0;
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 96; ++x) {
            const UV uv{(x + 0.5) / 96, (y + 0.5) / 48};
            const Vec3f d(latlong_direction(uv)), a = irradiance_.sample(d), b = sh_.sample(d);
            const double w = std::sin(uv.v * k_pi);
            error += w * dot(a - b, a - b);
            truth += w * dot(a, a);
        }
    return truth > 0 ? std::sqrt(error / truth) : 0;
}

// Widths follow from: environment 3 s + 20 by half of that, then two columns of balls of size s above lat-longs of half
// the height.
void Sheet::environment_row() {
    const int s = (width_ - 2 * k_margin - 60) / 5, width = (3 * s + 20) / 4 * 4, height = width / 2;
    const PreviewMap& sky = !environment_.empty() || levels_.empty() ? environment_ : levels_[0];
    if (!sky.empty()) {
        latlong_panel(k_margin, y_, width, sky);
        axis_names(k_margin, y_, width);
        caption(k_margin, y_ + height, width,
                environment_.empty() ? "environment, from the first level" : "environment",
                "lat-long, +X at the centre, +Z to its right");
    }
    int x = width_ - k_margin - 2 * s - k_gap;
    if (!irradiance_.empty()) {
        ball_panel(x, y_, s, irradiance_, false, 1);
        latlong_panel(x, y_ + s + 10, s, irradiance_);
        caption(x, y_ + height, s, "irradiance / π",
                in_.irradiance_detail.empty() ? size_text(*in_.irradiance_over_pi) : in_.irradiance_detail);
    }
    x += s + k_gap;
    if (!sh_.empty()) {
        ball_panel(x, y_, s, sh_, false, 1);
        latlong_panel(x, y_ + s + 10, s, sh_);
        const int bands = int(std::lround(std::sqrt(double(in_.sh.size()))));
        caption(x, y_ + height, s, fmt::format("the same of {} harmonics, {} bands", in_.sh.size(), bands),
                irradiance_.empty() ? "" : fmt::format("differs by {:.2f} % RMS", 100 * sh_difference_));
    }
    y_ += height + 2 * k_line + 34;
}

/// Levels side by side in one or several rows, and behind the last one the BRDF table where asked for.
void Sheet::level_grid(const std::vector<PreviewLevel>& levels, const std::vector<PreviewMap>& maps, const char* name,
                       bool with_table) {
    const int count = int(levels.size()), cells = count + with_table;
    if (cells == 0) return;
    const int rows = (cells + 7) / 8, columns = (cells + rows - 1) / rows;
    const int content = width_ - 2 * k_margin, cell = std::min((content - (columns - 1) * k_gap) / columns, 300);
    const bool cube = maps.empty() || maps[0].is_cube();
    const int unfolded = cube ? cell * 3 / 4 : cell / 2, height = cell + 10 + unfolded + 3 * k_line + 8;
    for (int i = 0; i < cells; ++i) {
        const int x = k_margin + i % columns * (cell + k_gap), y = y_ + i / columns * (height + 24);
        if (i == count) {
            brdf_panel(x, y, cell);
            brdf_caption(x, y + cell + 10, cell);
            continue;
        }
        const PreviewLevel& level = levels[std::size_t(i)];
        const PreviewMap& map = maps[std::size_t(i)];
        // If a rough lobe has smoothed the level, one lookup for each pixel is enough.
        const bool fine = level.map->height() > 64 && level.alpha < k_smooth_alpha;
        ball_panel(x, y, cell, map, true, fine ? 2 : 1);
        if (map.is_cube())
            cross_panel(x, y + cell + 10, cell, map);
        else
            latlong_panel(x, y + cell + 10, cell / 2 * 2, map);
        level_caption(x, y + cell + 10 + unfolded, cell, level,
                      level.name.empty() ? fmt::format("{} {} · {}", name, i, size_text(*level.map)) : level.name);
    }
    y_ += rows * (height + 24);
}

void Sheet::level_caption(int x, int y, int width, const PreviewLevel& level, const std::string& name) {
    text(x, y + 20, fit_text(name, FontSize::small, width));
    if (level.detail.empty()) {
        text(x, y + 20 + k_line, "roughness " + number(level.roughness), k_quiet);
        text(x, y + 20 + 2 * k_line, "α " + number(level.alpha), k_quiet);
    } else {
        text(x, y + 20 + k_line, fit_text(level.detail, FontSize::small, width), k_quiet);
    }
}

void Sheet::brdf_caption(int x, int y, int width) {
    const auto line = [&](int i, const std::string& words, Colour8 colour) {
        text(x, y + 14 + i * k_line, fit_text(words, FontSize::small, width), colour);
    };
    line(0, fmt::format("BRDF table, {} × {}", in_.brdf.width, in_.brdf.height), k_text);
    line(1, in_.brdf_detail, k_quiet);
    line(2, "→ N·V  ↓ roughness", k_quiet);
}

void Sheet::footer() {
    y_ += 2;
    text(k_margin, y_ + 14,
         fit_text("Balls are seen along −Z with +X to the right and +Y up: a chrome ball has +Z at its middle and −Z "
                  "around its rim.",
                  FontSize::small, width_ - 2 * k_margin - 120),
         k_quiet);
    text(width_ - k_margin, y_ + 14, "domelight", k_quiet, Align::right);
    y_ += 14 + k_margin - 4;
}

void Sheet::latlong_panel(int x, int y, int width, const PreviewMap& map) {
    const int height = width / 2;
    // The longitudes' sines and cosines, the same in every row.
    std::vector<std::pair<float, float>> turn;
    for (int i = 0; i < width; ++i) {
        const Vec3d d = latlong_direction({(i + 0.5) / width, 0.5});
        turn.emplace_back(float(d.x), float(d.z));
    }
    panels_.push_back(
        {{x, y, width, height},
         [this, x, y, width, height, turn = std::move(turn), &map](ImageView<std::uint8_t> image, int row) {
             const float v = (float(row) + 0.5f) / float(height);
             const float up = float(std::cos(k_pi * v)), around = float(std::sin(k_pi * v));
             const bool upright = map.is_upright_latlong();
             std::vector<std::uint32_t> line(turn.size());
             for (int i = 0; i < width; ++i) {
                 const auto [cosine, sine] = turn[std::size_t(i)];
                 const MapPlace place = upright ? MapPlace{0, (float(i) + 0.5f) / float(width), v}
                                                : map.place({around * cosine, up, around * sine});
                 line[std::size_t(i)] = look_.code(map.at(place));
             }
             store(line, image.at(x, y + row));
         }});
}

/// A horizontal cross: +Y above and -Y below +Z, with -X, +Z, +X, -Z in a row, so that edges which touch belong
/// together.
void Sheet::cross_panel(int x, int y, int width, const PreviewMap& map) {
    const int n = width / 4;
    panels_.push_back({{x, y, 4 * n, 3 * n}, [this, x, y, n, &map](ImageView<std::uint8_t> image, int row) {
                           static constexpr int faces[3][4] = {{-1, 2, -1, -1}, {1, 4, 0, 5}, {-1, 3, -1, -1}};
                           for (int column = 0; column < 4; ++column) {
                               const int face = faces[row / n][column];
                               if (face < 0) continue;
                               std::vector<std::uint32_t> line(static_cast<std::size_t>(n));
                               for (int i = 0; i < n; ++i)
                                   line[std::size_t(i)] = look_.code(map.at(
                                       {face, (float(i) + 0.5f) / float(n), (float(row % n) + 0.5f) / float(n)}));
                               store(line, image.at(x + column * n, y + row));
                           }
                       }});
}

std::shared_ptr<const Ball> Sheet::ball(bool cube, int size, bool chrome, int samples) {
    for (const auto& b : balls_)
        if (b->cube == cube && b->size == size && b->chrome == chrome && b->samples == samples) return b;
    return nullptr;
}

/// A ball of diameter `size` under an orthographic view along -Z. `chrome`: looked up in the mirror direction of the
/// view, else by the normal.
void Sheet::ball_panel(int x, int y, int size, const PreviewMap& map, bool chrome, int samples) {
    std::shared_ptr<const Ball> ball = this->ball(map.is_cube(), size, chrome, samples);
    if (!ball) {
        ball = std::make_shared<const Ball>(make_ball(map, size, chrome, samples, in_.threads));
        balls_.push_back(ball);
    }
    panels_.push_back({{x, y, size, size}, [this, x, y, ball, &map](ImageView<std::uint8_t> image, int row) {
                           const std::uint32_t per_pixel = std::uint32_t(ball->samples * ball->samples);
                           const std::size_t first = std::size_t(row) * std::size_t(ball->size);
                           const MapPlace* place = ball->places.data() + first * std::size_t(per_pixel);
                           for (int i = 0; i < ball->size; ++i, place += per_pixel) {
                               const float opacity = ball->opacity[first + std::size_t(i)];
                               if (opacity == 0) continue;
                               // The mean is of display values: a sun's edge stays smooth. Red and blue are added
                               // up in one number.
                               std::uint32_t red_blue = 0, green = 0;
                               for (std::uint32_t k = 0; k < per_pixel; ++k) {
                                   const std::uint32_t code = look_.code(map.at(place[k]));
                                   red_blue += code & 0xff00ff, green += code >> 8 & 0xff;
                               }
                               const auto mean = [&](std::uint32_t sum) {
                                   return std::uint8_t((sum + per_pixel / 2) / per_pixel);
                               };
                               const Colour8 colour{mean(red_blue & 0xffff), mean(green), mean(red_blue >> 16)};
                               std::uint8_t* pixel = image.at(x + i, y + row);
                               if (opacity < 1)
                                   blend(image, x + i, y + row, colour, opacity);
                               else
                                   pixel[0] = colour.r, pixel[1] = colour.g, pixel[2] = colour.b;
                           }
                       }});
}

void Sheet::brdf_panel(int x, int y, int size) {
    std::vector<std::uint8_t> codes;
    for (int i = 0; i < 4096; ++i) codes.push_back(to_byte(srgb_encode(float(i) / 4095)));
    panels_.push_back(
        {{x, y, size, size}, [this, x, y, size, codes = std::move(codes)](ImageView<std::uint8_t> image, int row) {
             const auto& t = in_.brdf;
             const auto place = [size](int i, int n) {
                 return std::clamp((float(i) + 0.5f) / float(size) * float(n) - 0.5f, 0.0f, float(n - 1));
             };
             const float fy = place(row, t.height);
             const int j = std::min(int(fy), std::max(t.height - 2, 0)), j1 = std::min(j + 1, t.height - 1);
             for (int i = 0; i < size; ++i) {
                 const float fx = place(i, t.width);
                 const int k = std::min(int(fx), std::max(t.width - 2, 0)), k1 = std::min(k + 1, t.width - 1);
                 const auto value = [&](int c) {
                     if (c >= std::min(t.channels, in_.brdf_channels)) return 0.0f;
                     const float a = t.at(k, j)[c] * (1 - (fx - k)) + t.at(k1, j)[c] * (fx - k);
                     const float b = t.at(k, j1)[c] * (1 - (fx - k)) + t.at(k1, j1)[c] * (fx - k);
                     return a * (1 - (fy - j)) + b * (fy - j);
                 };
                 std::uint8_t* p = image.at(x + i, y + row);
                 for (int c = 0; c < 3; ++c) p[c] = codes[std::size_t(std::clamp(value(c), 0.0f, 1.0f) * 4095 + 0.5f)];
             }
         }});
}

/// The names of the four directions around the horizon, along the bottom of a lat-long picture.
void Sheet::axis_names(int x, int y, int width) {
    static constexpr const char* names[] = {"−Z", "+X", "+Z"};
    for (int i = 0; i < 3; ++i) {
        const int at = x + width * (i + 1) / 4, baseline = y + width / 2 - 8;
        text(at + 1, baseline + 1, names[i], {0, 0, 0}, Align::centre);
        text(at, baseline, names[i], {255, 255, 255}, Align::centre);
    }
}

Image<std::uint8_t> Sheet::draw() const {
    Image<std::uint8_t> image(width_, y_, 3);
    fill(image.view(), {0, 0, width_, y_}, k_background);
    struct Stripe {
        const Panel* panel;
        int first, last;
    };
    std::vector<Stripe> stripes;
    for (const Panel& panel : panels_)
        for (int row = 0; row < panel.where.height; row += 32)
            stripes.push_back({&panel, row, std::min(row + 32, panel.where.height)});
    parallel_for(int(stripes.size()), in_.threads, [&](int i) {
        for (int row = stripes[i].first; row < stripes[i].last; ++row) stripes[i].panel->draw(image.view(), row);
    });
    for (const Text& t : texts_) draw_text(image.view(), t.x, t.baseline, t.text, t.size, t.colour, t.align);
    return image;
}

}  // namespace

Image<std::uint8_t> contact_sheet(const PreviewInput& input) {
    return Sheet(input).draw();
}

}  // namespace domelight
