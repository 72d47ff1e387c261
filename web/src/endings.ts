// The files that can be opened, by the ends of their names.

export const modelEndings = ['.glb', '.gltf'];
/// What the library knows as environments. Which of them its WebAssembly module reads is its own affair: it says so where it cannot.
export const environmentEndings = ['.hdr', '.exr', '.ktx2', '.ktx', '.dds', '.env', '.png', '.jpg', '.jpeg'];
/// What a .gltf names, which has to be dropped with it.
export const partEndings = ['.bin', '.webp'];
/// A set of probes: probes.json with its .ktx2 files.
export const probeEndings = ['.json'];
/// Models that the page does not read.
export const otherModelEndings = ['.obj', '.ply', '.fbx', '.usd', '.usda', '.usdc', '.usdz', '.blend', '.stl', '.3ds', '.dae', '.abc', '.max'];
export const pictureEndings = ['.hdr', '.exr'];

export const endsIn = (name: string, endings: string[]): boolean => endings.some(ending => name.toLowerCase().endsWith(ending));
