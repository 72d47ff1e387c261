// The search for a block of BC6H, for one block a lane: included by texture/block/bc6h_encode.cpp, where a lane is a float, and
// by texture/block/bc6h_encode.simd.cpp, once an instruction set. No include guard.
//
// The including namespace provides F (floats, one a lane) with + - * / and < <= >= >, M (truth values) with &, and
// splat(float), load(const float*), store(F, float*), lane_count(), select(M, F, F), smaller(F, F), larger(F, F),
// floor_of(F), half_bits_of(F) and any(M).
//
// All lanes take the same path and every operation rounds as IEEE 754 requires, so the bytes of a block depend neither
// on the width of a vector nor on the blocks in the other lanes. Integers are stored as floats: those of the format are
// below 2^24 and so exact.
//
// Colours are on the 16-bit scale on which the format interpolates; errors are sums of squares in half floats' bits,
// where one step is the same ratio everywhere above 2^-14.

constexpr float k_top = 65535;
/// Decoding takes 31/64 of an interpolated value, rounded down.
constexpr float k_per_bit = 64.0f / 31;

struct Colour {
    F c[3];
};

F dot(const Colour& a, const Colour& b) {
    return a.c[0] * b.c[0] + a.c[1] * b.c[1] + a.c[2] * b.c[2];
}

/// The texels to be stored.
struct Target {
    Colour bits[k_texels];   ///< half floats' bits
    Colour value[k_texels];  ///< the middle of what decodes to them
};

/// The numbers of a mode, one for each lane. In most of the search all lanes have the same mode.
struct Rules {
    F grid, offset;  ///< 16-bit value of an end: end * grid + offset, but 0 and 65535 at the two extremes
    F top;           ///< the largest end
    F reach[3];      ///< ends lie between the first one minus this and the first one plus this minus 1
    F last;          ///< the largest index
    F index_weight;  ///< weight of the second end for each index, in 64ths, before rounding
};

/// Which texels belong to the second subset (1, otherwise 0), and the position of its shortened index.
struct Subsets {
    F second[k_texels];
    F anchor;
};

/// Both ends of one or two lines; `end` 0 and 1 are the first subset's.
struct Ends {
    Colour end[4];
};

struct Solution {
    Ends ends;  ///< whole numbers of the mode's precision
    F index[k_texels];
    F error;
};

struct Best {
    Solution solution;
    F mode, partition;
};

F clamp_to(F v, float low, float high) {
    return smaller(larger(v, splat(low)), splat(high));
}

F pick(const F& second, const F& if_first, const F& if_second) {
    return select(second > splat(0.5f), if_second, if_first);
}

/// The members of Rules in their order.
struct ModeNumbers {
    float of[8];
};

ModeNumbers numbers_of(const Mode& mode) {
    const int bits = mode.endpoint_bits;
    // In a mode of 16 bits, ends are values; a mode without differences can store any end.
    ModeNumbers n{{float(1 << (16 - bits)), bits == 16 ? 0 : float(1 << (15 - bits)), float((1 << bits) - 1)}};
    for (int c = 0; c < 3; ++c) n.of[3 + c] = mode.transformed ? float(1 << (mode.delta_bits[c] - 1)) : 65536;
    n.of[6] = float((1 << mode.index_bits()) - 1);
    n.of[7] = 64 / n.of[6];
    return n;
}

Rules rules_of(const Mode& mode) {
    const ModeNumbers n = numbers_of(mode);
    return {splat(n.of[0]), splat(n.of[1]), splat(n.of[2]), {splat(n.of[3]), splat(n.of[4]), splat(n.of[5])},
            splat(n.of[6]), splat(n.of[7])};
}

// ---- Lines ----

struct Covariance {
    F rr, rg, rb, gg, gb, bb;
};

Covariance square(const Covariance& m) {
    return {m.rr * m.rr + m.rg * m.rg + m.rb * m.rb, m.rr * m.rg + m.rg * m.gg + m.rb * m.gb,
            m.rr * m.rb + m.rg * m.gb + m.rb * m.bb, m.rg * m.rg + m.gg * m.gg + m.gb * m.gb,
            m.rg * m.rb + m.gg * m.gb + m.gb * m.bb, m.rb * m.rb + m.gb * m.gb + m.bb * m.bb};
}

Colour times(const Covariance& m, const Colour& v) {
    return {{m.rr * v.c[0] + m.rg * v.c[1] + m.rb * v.c[2], m.rg * v.c[0] + m.gg * v.c[1] + m.gb * v.c[2],
             m.rb * v.c[0] + m.gb * v.c[1] + m.bb * v.c[2]}};
}

/// Direction of the largest spread; zero where there is none. Multiplication by the covariance turns any vector towards
/// it, and squaring the matrix three times replaces eight multiplications; the column with the largest diagonal is the
/// best start.
Colour principal_axis(const Covariance& covariance) {
    Covariance m = covariance;
    for (int i = 0; i < 3; ++i) {
        const F largest = larger(m.rr, larger(m.gg, m.bb));
        const F scale = select(largest > splat(0), splat(1) / largest, splat(0));
        m = square({m.rr * scale, m.rg * scale, m.rb * scale, m.gg * scale, m.gb * scale, m.bb * scale});
    }
    const M green = m.gg > m.rr, blue = m.bb > larger(m.rr, m.gg);
    return {{select(blue, m.rb, select(green, m.rg, m.rr)), select(blue, m.gb, select(green, m.gg, m.rg)),
             select(blue, m.bb, select(green, m.gb, m.rb))}};
}

/// The remaining spread about the principal axis.
F spread_about_axis(const Covariance& m) {
    const Colour axis = principal_axis(m);
    const F length = dot(axis, axis), all = m.rr + m.gg + m.bb;
    const F along = dot(axis, times(m, axis)) / length;
    return larger(splat(0), select(length > splat(0), all - along, all));
}

/// Principal axis of one subset (`want` 0 or 1), its ends at the outermost texels.
void fit_axis(const Target& target, const Subsets& subsets, float want, Colour& low_end, Colour& high_end) {
    F count = splat(0);
    Colour mean{{splat(0), splat(0), splat(0)}};
    F weight[k_texels];
    for (int t = 0; t < k_texels; ++t) {
        weight[t] = want > 0.5f ? subsets.second[t] : splat(1) - subsets.second[t];
        count = count + weight[t];
        for (int c = 0; c < 3; ++c) mean.c[c] = mean.c[c] + weight[t] * target.value[t].c[c];
    }
    for (F& v : mean.c) v = v / count;
    Covariance m{splat(0), splat(0), splat(0), splat(0), splat(0), splat(0)};
    for (int t = 0; t < k_texels; ++t) {
        const F r = target.value[t].c[0] - mean.c[0], g = target.value[t].c[1] - mean.c[1],
                b = target.value[t].c[2] - mean.c[2];
        const F wr = weight[t] * r, wg = weight[t] * g, wb = weight[t] * b;
        m.rr = m.rr + wr * r;
        m.rg = m.rg + wr * g;
        m.rb = m.rb + wr * b;
        m.gg = m.gg + wg * g;
        m.gb = m.gb + wg * b;
        m.bb = m.bb + wb * b;
    }
    const Colour axis = principal_axis(m);
    const F length = dot(axis, axis), scale = select(length > splat(0), splat(1) / length, splat(0));
    F low = splat(0), high = splat(0);
    for (int t = 0; t < k_texels; ++t) {
        const Colour from_mean{
            {target.value[t].c[0] - mean.c[0], target.value[t].c[1] - mean.c[1], target.value[t].c[2] - mean.c[2]}};
        const F at = weight[t] * (dot(axis, from_mean) * scale);
        low = smaller(low, at);
        high = larger(high, at);
    }
    for (int c = 0; c < 3; ++c) {
        low_end.c[c] = clamp_to(mean.c[c] + low * axis.c[c], 0, k_top);
        high_end.c[c] = clamp_to(mean.c[c] + high * axis.c[c], 0, k_top);
    }
}

/// The weight of the second end for an index, in 64ths: the format's tables are these products, rounded.
F weight_of_index(const F& index, const Rules& rules) {
    return floor_of(index * rules.index_weight + splat(0.5f));
}

/// The line of one subset, prepared for projections.
struct Projector {
    Colour start, along;  ///< along: scaled so that texels give indices
};

Projector projector(const Colour& first, const Colour& second, const Rules& rules) {
    Projector p;
    p.start = first;
    for (int c = 0; c < 3; ++c) p.along.c[c] = second.c[c] - first.c[c];
    const F length = dot(p.along, p.along);
    const F scale = select(length > splat(0), rules.last / length, splat(0));
    for (F& v : p.along.c) v = v * scale;
    return p;
}

F nearest_index(const Colour& texel, const Colour& start, const Colour& along, const F& last) {
    const F at = dot(along, {{texel.c[0] - start.c[0], texel.c[1] - start.c[1], texel.c[2] - start.c[2]}});
    return smaller(larger(floor_of(at + splat(0.5f)), splat(0)), last);
}

/// Reverses lines on which the anchor lies in the second half, because the top bit of its index is not stored.
void orient(const Target& target, const Subsets& subsets, int count, Ends& ends) {
    for (int s = 0; s < count; ++s) {
        Colour& first = ends.end[2 * s];
        Colour& second = ends.end[2 * s + 1];
        F balance = splat(0);
        for (int c = 0; c < 3; ++c) {
            F at = target.value[0].c[c];
            if (s == 1)
                at = select(subsets.anchor > splat(12), target.value[15].c[c],
                            select(subsets.anchor > splat(5), target.value[8].c[c], target.value[2].c[c]));
            balance = balance + (at + at - first.c[c] - second.c[c]) * (second.c[c] - first.c[c]);
        }
        const M turn = balance > splat(0);
        for (int c = 0; c < 3; ++c) {
            const F f = first.c[c], g = second.c[c];
            first.c[c] = select(turn, g, f);
            second.c[c] = select(turn, f, g);
        }
    }
}

/// The ends that fit the texels best for the weights of their indices.
void least_squares(const Target& target, const Subsets& subsets, const Rules& rules, int count, const F* index,
                   Ends& ends) {
    for (int s = 0; s < count; ++s) {
        F aa = splat(0), ab = aa, bb = aa, total = aa;
        Colour ax{{aa, aa, aa}}, bx = ax, sum = ax;
        for (int t = 0; t < k_texels; ++t) {
            const F member = count == 1 ? splat(1) : s == 1 ? subsets.second[t] : splat(1) - subsets.second[t];
            const F b = weight_of_index(index[t], rules) * splat(1.0f / 64), a = splat(1) - b;
            const F wa = member * a, wb = member * b;
            aa = aa + wa * a;
            ab = ab + wa * b;
            bb = bb + wb * b;
            total = total + member;
            for (int c = 0; c < 3; ++c) {
                ax.c[c] = ax.c[c] + wa * target.value[t].c[c];
                bx.c[c] = bx.c[c] + wb * target.value[t].c[c];
                sum.c[c] = sum.c[c] + member * target.value[t].c[c];
            }
        }
        const F determinant = aa * bb - ab * ab;
        const M solvable = determinant > splat(1e-4f);
        for (int c = 0; c < 3; ++c) {
            const F mean = sum.c[c] / total;
            ends.end[2 * s].c[c] =
                clamp_to(select(solvable, (bb * ax.c[c] - ab * bx.c[c]) / determinant, mean), 0, k_top);
            ends.end[2 * s + 1].c[c] =
                clamp_to(select(solvable, (aa * bx.c[c] - ab * ax.c[c]) / determinant, mean), 0, k_top);
        }
    }
}

/// The lines through `count` subsets: principal axes, then rounds of nearest indices and least squares.
Ends fit_lines(const Target& target, const Subsets& subsets, int count, int rounds) {
    const Rules rules = rules_of(k_mode[count == 2 ? 0 : 10]);
    Ends ends{};
    for (int s = 0; s < count; ++s) fit_axis(target, subsets, float(s), ends.end[2 * s], ends.end[2 * s + 1]);
    for (int i = 0; i < rounds; ++i) {
        F index[k_texels];
        const Projector first = projector(ends.end[0], ends.end[1], rules),
                        second = count == 2 ? projector(ends.end[2], ends.end[3], rules) : first;
        for (int t = 0; t < k_texels; ++t) {
            Colour start, along;
            for (int c = 0; c < 3; ++c) {
                start.c[c] = pick(subsets.second[t], first.start.c[c], second.start.c[c]);
                along.c[c] = pick(subsets.second[t], first.along.c[c], second.along.c[c]);
            }
            index[t] = nearest_index(target.value[t], start, along, rules.last);
        }
        least_squares(target, subsets, rules, count, index, ends);
    }
    orient(target, subsets, count, ends);
    return ends;
}

// ---- Blocks ----

/// Nearest whole numbers of a mode's precision.
void snap(const Rules& rules, int count, Ends& ends) {
    const F scale = splat(1) / rules.grid;
    for (int e = 0; e < 2 * count; ++e)
        for (F& v : ends.end[e].c) v = smaller(larger(floor_of(v * scale), splat(0)), rules.top);
}

/// Moves the other ends into the range of the mode's differences from the first.
void bring_into_reach(const Rules& rules, int count, Ends& ends) {
    for (int c = 0; c < 3; ++c) {
        const F low = ends.end[0].c[c] - rules.reach[c], high = ends.end[0].c[c] + rules.reach[c] - splat(1);
        for (int e = 1; e < 2 * count; ++e)
            ends.end[e].c[c] = smaller(larger(smaller(larger(ends.end[e].c[c], low), high), splat(0)), rules.top);
    }
}

F unquantised(const F& end, const Rules& rules) {
    return select(end < splat(0.5f), splat(0),
                  select(end > rules.top - splat(0.5f), splat(k_top), end * rules.grid + rules.offset));
}

/// Squared error of a texel at an index.
F texel_error(const Colour& bits, const Colour& start, const Colour& end, const F& index, const Rules& rules) {
    const F w = weight_of_index(index, rules), rest = splat(64) - w;
    F error = splat(0);
    for (int c = 0; c < 3; ++c) {
        const F value = floor_of((start.c[c] * rest + end.c[c] * w + splat(32)) * splat(1.0f / 64));
        const F d = floor_of(value * splat(31) * splat(1.0f / 64)) - bits.c[c];
        error = error + d * d;
    }
    return error;
}

/// The best indices for given ends, and their error. The index nearest to a texel's projection is the best up to
/// rounding; with `neighbours` those beside it are tried too.
void evaluate(const Target& target, const Subsets& subsets, const Rules& rules, int count, bool neighbours,
              Solution& s) {
    Ends colours;
    for (int e = 0; e < 2 * count; ++e)
        for (int c = 0; c < 3; ++c) colours.end[e].c[c] = unquantised(s.ends.end[e].c[c], rules);
    Projector line[2];
    for (int i = 0; i < count; ++i) line[i] = projector(colours.end[2 * i], colours.end[2 * i + 1], rules);
    // An anchor can still lie beyond the middle of its line after orient() because of rounding; its index is then
    // clamped.
    const F last_of_anchor = (rules.last - splat(1)) * splat(0.5f);
    s.error = splat(0);
    for (int t = 0; t < k_texels; ++t) {
        Colour start = line[0].start, along = line[0].along, end = colours.end[1];
        if (count == 2)
            for (int c = 0; c < 3; ++c) {
                start.c[c] = pick(subsets.second[t], start.c[c], line[1].start.c[c]);
                along.c[c] = pick(subsets.second[t], along.c[c], line[1].along.c[c]);
                end.c[c] = pick(subsets.second[t], end.c[c], colours.end[3].c[c]);
            }
        F last = t == 0 ? last_of_anchor : rules.last;
        if (count == 2 && (t == 2 || t == 8 || t == 15)) {
            const F distance = subsets.anchor - splat(float(t));
            last = select(distance * distance < splat(0.5f), last_of_anchor, last);
        }
        const F nearest = nearest_index(target.value[t], start, along, last);
        F index = nearest, error = texel_error(target.bits[t], start, end, index, rules);
        if (neighbours)
            for (const float step : {-1.0f, 1.0f}) {
                const F other = smaller(larger(nearest + splat(step), splat(0)), last),
                        other_error = texel_error(target.bits[t], start, end, other, rules);
                const M better = other_error < error;
                index = select(better, other, index);
                error = select(better, other_error, error);
            }
        s.index[t] = index;
        s.error = s.error + error;
    }
}

/// Keeps the better block, lane by lane.
void keep_better(const Solution& s, const M& better, Solution& best) {
    for (int e = 0; e < 4; ++e)
        for (int c = 0; c < 3; ++c) best.ends.end[e].c[c] = select(better, s.ends.end[e].c[c], best.ends.end[e].c[c]);
    for (int t = 0; t < k_texels; ++t) best.index[t] = select(better, s.index[t], best.index[t]);
    best.error = select(better, s.error, best.error);
}

/// Moves single ends in single channels of the blocks in `open`, round after round as long as a block improves.
void nudge(const Target& target, const Subsets& subsets, const Rules& rules, int count, const M& open, int rounds,
           const Effort& effort, Solution& best) {
    for (int round = 0; round < rounds; ++round) {
        bool changed = false;
        for (int e = 0; e < 2 * count; ++e)
            for (int c = 0; c < 3; ++c)
                for (float step = 1; std::abs(step) <= effort.step; step = step > 0 ? -step : -2 * step) {
                    Solution s = best;
                    s.ends.end[e].c[c] = smaller(larger(s.ends.end[e].c[c] + splat(step), splat(0)), rules.top);
                    bring_into_reach(rules, count, s.ends);
                    evaluate(target, subsets, rules, count, effort.neighbours, s);
                    const M better = (s.error < best.error) & open;
                    if (!any(better)) continue;
                    keep_better(s, better, best);
                    changed = true;
                }
        if (!changed) break;
    }
}

/// The best block of one mode that the search finds from `lines`.
Solution quantise(const Target& target, const Subsets& subsets, const Rules& rules, int count, const Ends& lines,
                  const Effort& effort) {
    Solution best{};
    best.ends = lines;
    snap(rules, count, best.ends);
    bring_into_reach(rules, count, best.ends);
    evaluate(target, subsets, rules, count, effort.neighbours, best);
    for (int i = 0; i < effort.refits; ++i) {
        Solution s = best;
        least_squares(target, subsets, rules, count, best.index, s.ends);
        snap(rules, count, s.ends);
        bring_into_reach(rules, count, s.ends);
        evaluate(target, subsets, rules, count, effort.neighbours, s);
        keep_better(s, s.error < best.error, best);
    }
    return best;
}

/// Tries all modes from `first` to `last`. With `nudged`, the ends of a block are moved if its error is within
/// effort.reach of the best error so far.
void try_modes(const Target& target, const Subsets& subsets, const F& partition, int first, int last,
               const Effort& effort, bool nudged, Best& best) {
    const int count = k_mode[std::size_t(first)].subsets;
    const Ends lines = fit_lines(target, subsets, count, effort.fits);
    for (int m = first; m <= last; ++m) {
        const Rules rules = rules_of(k_mode[std::size_t(m)]);
        Solution s = quantise(target, subsets, rules, count, lines, effort);
        if (nudged) {
            const M open = s.error < best.solution.error * splat(effort.reach);
            if (!any(open)) continue;
            nudge(target, subsets, rules, count, open, effort.nudges, effort, s);
        }
        const M better = s.error < best.solution.error;
        if (!any(better)) continue;
        keep_better(s, better, best.solution);
        best.mode = select(better, splat(float(m)), best.mode);
        best.partition = select(better, partition, best.partition);
    }
}

/// The partitions with the least spread about their two axes, best first.
void rank_partitions(const Target& target, int count, F* ranked) {
    // Sums of values and products about the block's mean: those of the first subset are the block's less the second's.
    Colour mean{{splat(0), splat(0), splat(0)}};
    for (int t = 0; t < k_texels; ++t)
        for (int c = 0; c < 3; ++c) mean.c[c] = mean.c[c] + target.value[t].c[c];
    F terms[k_texels][9], all[9];
    for (F& v : all) v = splat(0);
    for (int t = 0; t < k_texels; ++t) {
        const F r = target.value[t].c[0] - mean.c[0] * splat(1.0f / 16),
                g = target.value[t].c[1] - mean.c[1] * splat(1.0f / 16),
                b = target.value[t].c[2] - mean.c[2] * splat(1.0f / 16);
        const F term[9] = {r, g, b, r * r, r * g, r * b, g * g, g * b, b * b};
        for (int i = 0; i < 9; ++i) {
            terms[t][i] = term[i];
            all[i] = all[i] + term[i];
        }
    }
    F least[k_partitions];
    for (int i = 0; i < count; ++i) least[i] = splat(1e30f), ranked[i] = splat(0);
    for (int p = 0; p < k_partitions; ++p) {
        F sums[2][9];
        for (F& v : sums[1]) v = splat(0);
        float members = 0;
        for (int t = 0; t < k_texels; ++t) {
            if (!(k_partition[std::size_t(p)] >> t & 1)) continue;
            members += 1;
            for (int i = 0; i < 9; ++i) sums[1][i] = sums[1][i] + terms[t][i];
        }
        for (int i = 0; i < 9; ++i) sums[0][i] = all[i] - sums[1][i];
        F spread = splat(0);
        for (int s = 0; s < 2; ++s) {
            const F* m = sums[s];
            const F n = splat(1 / (s == 1 ? members : 16 - members));
            spread =
                spread + spread_about_axis({m[3] - m[0] * m[0] * n, m[4] - m[0] * m[1] * n, m[5] - m[0] * m[2] * n,
                                            m[6] - m[1] * m[1] * n, m[7] - m[1] * m[2] * n, m[8] - m[2] * m[2] * n});
        }
        // Insertion sort: the better partition takes the place, and the others move by one.
        F partition = splat(float(p));
        for (int i = 0; i < count; ++i) {
            const M better = spread < least[i];
            const F next_spread = select(better, least[i], spread), next = select(better, ranked[i], partition);
            least[i] = select(better, spread, least[i]);
            ranked[i] = select(better, partition, ranked[i]);
            spread = next_spread;
            partition = next;
        }
    }
}

/// Per lane; a mode of one subset has no second one.
Subsets subsets_of(const F& partition, const F& mode) {
    float number[k_max_lanes], modes[k_max_lanes], second[k_texels][k_max_lanes], anchor[k_max_lanes];
    store(partition, number);
    store(mode, modes);
    for (int lane = 0; lane < lane_count(); ++lane) {
        const std::size_t p = std::size_t(number[lane]);
        const bool two = k_mode[std::size_t(modes[lane])].subsets == 2;
        for (int t = 0; t < k_texels; ++t) second[t][lane] = float(two && (k_partition[p] >> t & 1));
        anchor[lane] = float(two ? k_anchor[p] : 0);
    }
    Subsets subsets;
    for (int t = 0; t < k_texels; ++t) subsets.second[t] = load(second[t]);
    subsets.anchor = load(anchor);
    return subsets;
}

/// Each lane's own mode.
Rules rules_of(const F& mode) {
    float numbers[k_max_lanes], column[8][k_max_lanes];
    store(mode, numbers);
    for (int lane = 0; lane < lane_count(); ++lane) {
        const ModeNumbers n = numbers_of(k_mode[std::size_t(numbers[lane])]);
        for (int i = 0; i < 8; ++i) column[i][lane] = n.of[i];
    }
    return {load(column[0]), load(column[1]), load(column[2]), {load(column[3]), load(column[4]), load(column[5])},
            load(column[6]), load(column[7])};
}

Best search(const Target& target, const Effort& effort) {
    Best best{};
    best.solution.error = splat(1e30f);
    best.mode = best.partition = splat(0);
    Subsets one;
    for (F& v : one.second) v = splat(0);
    one.anchor = splat(0);
    F ranked[k_partitions];
    if (effort.partitions > 0) rank_partitions(target, effort.partitions, ranked);
    for (const bool nudged : {false, true}) {
        if (nudged && effort.nudges == 0) break;
        try_modes(target, one, splat(0), 10, 13, effort, nudged, best);
        for (int i = 0; i < effort.partitions; ++i)
            try_modes(target, subsets_of(ranked[i], splat(0)), ranked[i], 0, 9, effort, nudged, best);
    }
    if (effort.polish > 0)
        nudge(target, subsets_of(best.partition, best.mode), rules_of(best.mode), 2, splat(0) < splat(1), effort.polish,
              effort, best.solution);
    return best;
}

/// Encodes up to lane_count() blocks.
void encode_lanes(const float* texels, int count, const Effort& effort, std::uint8_t* blocks) {
    const int lanes = lane_count();
    float column[k_max_lanes], result[2 + 12 + k_texels][k_max_lanes];
    Target target;
    for (int t = 0; t < k_texels; ++t)
        for (int c = 0; c < 3; ++c) {
            for (int lane = 0; lane < lanes; ++lane) column[lane] = texels[48 * (lane < count ? lane : 0) + 3 * t + c];
            target.bits[t].c[c] = half_bits_of(load(column));
            target.value[t].c[c] = (target.bits[t].c[c] + splat(0.5f)) * splat(k_per_bit);
        }
    const Best best = search(target, effort);
    store(best.mode, result[0]);
    store(best.partition, result[1]);
    for (int e = 0; e < 4; ++e)
        for (int c = 0; c < 3; ++c) store(best.solution.ends.end[e].c[c], result[2 + 3 * e + c]);
    for (int t = 0; t < k_texels; ++t) store(best.solution.index[t], result[14 + t]);
    for (int lane = 0; lane < count; ++lane) {
        int mode = int(result[0][lane]), ends[12], index[k_texels];
        for (int i = 0; i < 12; ++i) ends[i] = int(result[2 + i][lane]);
        for (int t = 0; t < k_texels; ++t) index[t] = int(result[14 + t][lane]);
        pack_solution(mode, int(result[1][lane]), ends, index, blocks + k_block_bytes * lane);
    }
}
