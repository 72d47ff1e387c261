#pragma once
// The files of texture.h and babylon_env.h in memory: what write_ktx2() and the others write, byte for byte.

#include "domelight/base/result.h"
#include "domelight/texture/container/babylon_env.h"
#include "domelight/texture/texture.h"

namespace domelight {

/// Errors: a texture that the container cannot store.
Result<TexelBytes> ktx2_bytes(const Texture& texture, Supercompression compression = Supercompression::none);
Result<TexelBytes> ktx1_bytes(const Texture& texture);
Result<TexelBytes> dds_bytes(const Texture& texture);
Result<TexelBytes> dds9_bytes(const Texture& texture);
Result<TexelBytes> env_bytes(const BabylonEnv& env, int threads = 0);

}  // namespace domelight
