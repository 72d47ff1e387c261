#include "texture/container/texture_stream.h"

#include "domelight/base/parallel.h"
#include "domelight/io/file/atomic_file.h"

#include "io/file/output_file.h"
#include "io/file/sha256.h"
#include "texture/chain_encoder.h"

#include <algorithm>
#include <atomic>
#include <optional>

namespace domelight {

namespace {

/// The number of bytes of texels that are encoded, written and hashed together, so that they stay in the core's cache.
constexpr std::size_t k_piece_bytes = std::size_t(128) << 10;
/// Rows of blocks take much longer than rows of texels, so a piece has few of them, and all threads have work.
constexpr int k_piece_block_rows = 8;

/// A part of the file: existing bytes, or rows to encode.
struct Piece {
    std::uint64_t offset;
    std::span<const std::uint8_t> frame;
    int level = 0, first = 0, rows = 0;
};

/// The file from the front to the back, without gaps.
std::vector<Piece> list_pieces(const ChainEncoder& encoder, const TextureLayout& layout) {
    std::vector<Piece> pieces;
    for (const TextureLayout::Frame& frame : layout.frame) pieces.push_back({frame.offset, frame.bytes});
    for (const TextureLayout::Block& block : layout.blocks) {
        const std::size_t row_bytes = encoder.row_bytes(block.level);
        const int rows = encoder.rows(block.level), begin = block.first_face * rows, end = begin + block.faces * rows,
                  step = encoding_block(encoder.head().encoding) > 1
                             ? k_piece_block_rows
                             : int(std::max<std::size_t>(1, k_piece_bytes / row_bytes));
        for (int row = begin; row < end; row += step)
            pieces.push_back({block.offset + row_bytes * std::uint64_t(row - begin),
                              {},
                              block.level,
                              row,
                              std::min(step, end - row)});
    }
    std::sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) { return a.offset < b.offset; });
    return pieces;
}

/// Lets parallel tasks do a part of their work one after the other, in the order of their numbers. Each task must
/// create a Turn first and destroy it last, in all cases, because the next task waits for it.
class Queue {
  public:
    class Turn {
      public:
        Turn(Queue& queue, int number) : queue_(queue), number_(number) {}
        ~Turn() {
            await();
            queue_.next_.store(number_ + 1);
            queue_.next_.notify_all();
        }
        Turn(const Turn&) = delete;
        Turn& operator=(const Turn&) = delete;
        /// Returns once all tasks with lower numbers have finished.
        void await() const {
            for (int now; (now = queue_.next_.load()) != number_;) queue_.next_.wait(now);
        }

      private:
        Queue& queue_;
        const int number_;
    };

  private:
    std::atomic<int> next_{0};
};

}  // namespace

Result<std::string> encode_to_file(const std::filesystem::path& file, ChainEncoder& encoder,
                                   const TextureLayout& layout, int threads, bool hash) {
    const std::vector<Piece> pieces = list_pieces(encoder, layout);
    Sha256 sha256;
    const auto written = write_file_atomically(file, [&](const std::filesystem::path& path) {
        OutputFile out(path);
        Queue queue;
        // The pieces are taken in order, so the task with the lowest number never waits.
        parallel_for(int(pieces.size()), threads, [&](int i) {
            std::optional<Queue::Turn> turn;
            if (hash) turn.emplace(queue, i);
            const Piece& piece = pieces[i];
            std::span<const std::uint8_t> bytes = piece.frame;
            thread_local TexelBytes texels;  // keeps its memory from piece to piece
            if (piece.rows > 0) {
                texels.resize(encoder.row_bytes(piece.level) * std::size_t(piece.rows));
                encoder.encode(piece.level, piece.first, piece.rows, texels.data());
                bytes = texels;
            }
            out.write_at(piece.offset, bytes);
            if (!turn) return;
            turn->await();
            sha256.add(bytes);
        });
        return out.finish();
    });
    if (!written) return written.error();
    return hash ? sha256.finish() : std::string();
}

}  // namespace domelight
