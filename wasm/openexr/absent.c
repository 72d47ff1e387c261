// Compressions of OpenEXR that the module leaves out: HTJ2K needs a JPEG 2000 library, and Zstandard's file needs threads. The readers say that the file cannot be decoded.

#include "internal_compress.h"
#include "internal_decompress.h"

exr_result_t internal_exr_undo_ht(exr_decode_pipeline_t* decode, const void* packed, uint64_t packed_size, void* out, uint64_t size) {
    (void)decode, (void)packed, (void)packed_size, (void)out, (void)size;
    return EXR_ERR_FEATURE_NOT_IMPLEMENTED;
}
exr_result_t internal_exr_undo_zstd(exr_decode_pipeline_t* decode, const void* packed, uint64_t packed_size, void* out, uint64_t size) {
    (void)decode, (void)packed, (void)packed_size, (void)out, (void)size;
    return EXR_ERR_FEATURE_NOT_IMPLEMENTED;
}
exr_result_t internal_exr_apply_ht(exr_encode_pipeline_t* encode) {
    (void)encode;
    return EXR_ERR_FEATURE_NOT_IMPLEMENTED;
}
exr_result_t internal_exr_apply_zstd(exr_encode_pipeline_t* encode) {
    (void)encode;
    return EXR_ERR_FEATURE_NOT_IMPLEMENTED;
}
