"""Writes draco.glb, a plate whose geometry Draco has compressed, and ktx2.glb, one whose base colour is a KTX2 picture of Basis Universal.

    pip install DracoPy alktx2 numpy pillow && python3 make.py
"""

import io
import json
import struct

import alktx2
import DracoPy
import numpy as np
from PIL import Image

N = 9
GRID = np.linspace(-1, 1, N)
POSITIONS = np.array([[x, y, 0.2 * np.cos(2 * x) * np.cos(2 * y)] for y in GRID for x in GRID], np.float32)
UVS = np.array([[(x + 1) / 2, (1 - y) / 2] for y in GRID for x in GRID], np.float32)
CELLS = [(j * N + i, (j + 1) * N + i) for j in range(N - 1) for i in range(N - 1)]
FACES = np.array([f for a, b in CELLS for f in ((a, a + 1, b + 1), (a, b + 1, b))], np.uint16)
BOUNDS = {'min': POSITIONS.min(0).tolist(), 'max': POSITIONS.max(0).tolist()}


def write_glb(name, document, parts):
    """A binary glTF of one node `plate`; `parts` become its buffer views."""
    blob, views = b'', []
    for part in parts:
        views.append({'buffer': 0, 'byteOffset': len(blob), 'byteLength': len(part)})
        blob += part + b'\0' * (-len(part) % 4)
    document = {'asset': {'version': '2.0'}, 'scene': 0, 'scenes': [{'nodes': [0]}], 'nodes': [{'mesh': 0, 'name': 'plate'}], 'bufferViews': views,
                'buffers': [{'byteLength': len(blob)}], **document}
    text = json.dumps(document, separators=(',', ':')).encode()
    text += b' ' * (-len(text) % 4)
    with open(name, 'wb') as file:
        file.write(struct.pack('<III', 0x46546c67, 2, 28 + len(text) + len(blob)) + struct.pack('<II', len(text), 0x4e4f534a) + text +
                   struct.pack('<II', len(blob), 0x4e4942) + blob)


def vertices(view, kind, **more):
    return {'componentType': 5126, 'count': N * N, 'type': kind, **({} if view is None else {'bufferView': view}), **more}


def write_draco():
    extension = 'KHR_draco_mesh_compression'
    packed = DracoPy.encode(POSITIONS, FACES, quantization_bits=12, compression_level=7)
    write_glb('draco.glb', {
        'extensionsUsed': [extension], 'extensionsRequired': [extension],
        'accessors': [vertices(None, 'VEC3', **BOUNDS), {'componentType': 5123, 'count': FACES.size, 'type': 'SCALAR'}],
        'materials': [{'pbrMetallicRoughness': {'baseColorFactor': [0.8, 0.1, 0.1, 1], 'metallicFactor': 0, 'roughnessFactor': 0.4}, 'doubleSided': True}],
        'meshes': [{'primitives': [{'attributes': {'POSITION': 0}, 'indices': 1, 'material': 0,
                                    'extensions': {extension: {'bufferView': 0, 'attributes': {'POSITION': 0}}}}]}],
    }, [packed])


def write_ktx2():
    """Red and green above, blue below."""
    picture = np.zeros((16, 16, 4), np.uint8)
    picture[:8, :8], picture[:8, 8:], picture[8:] = [230, 30, 30, 255], [30, 200, 30, 255], [40, 60, 230, 255]
    png = io.BytesIO()
    Image.fromarray(picture).save(png, 'PNG')
    normals = np.tile(np.array([0, 0, 1], np.float32), (N * N, 1))
    write_glb('ktx2.glb', {
        'extensionsUsed': ['KHR_texture_basisu'], 'extensionsRequired': ['KHR_texture_basisu'],
        'accessors': [vertices(0, 'VEC3', **BOUNDS), vertices(1, 'VEC3'), vertices(2, 'VEC2'),
                      {'bufferView': 3, 'componentType': 5123, 'count': FACES.size, 'type': 'SCALAR'}],
        'images': [{'bufferView': 4, 'mimeType': 'image/ktx2'}], 'textures': [{'extensions': {'KHR_texture_basisu': {'source': 0}}}],
        'materials': [{'pbrMetallicRoughness': {'baseColorTexture': {'index': 0}, 'metallicFactor': 0, 'roughnessFactor': 0.6}, 'doubleSided': True}],
        'meshes': [{'primitives': [{'attributes': {'POSITION': 0, 'NORMAL': 1, 'TEXCOORD_0': 2}, 'indices': 3, 'material': 0}]}],
    }, [POSITIONS.tobytes(), normals.tobytes(), UVS.tobytes(), FACES.tobytes(), bytes(alktx2.encode_bytes_to_ktx2(png.getvalue(), mime='image/png'))])


write_draco()
write_ktx2()
