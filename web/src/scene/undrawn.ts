// What a glTF file has and the page does not draw.

const layers: Record<string, string> = {
    KHR_materials_anisotropy: 'anisotropy', KHR_materials_clearcoat: 'clear coat', KHR_materials_diffuse_transmission: 'diffuse transmission', KHR_materials_dispersion: 'dispersion',
    KHR_materials_iridescence: 'iridescence', KHR_materials_pbrSpecularGlossiness: 'specular-glossiness', KHR_materials_sheen: 'sheen', KHR_materials_subsurface: 'subsurface scattering',
    KHR_materials_transmission: 'transmission', KHR_materials_volume: 'absorption', EXT_lights_image_based: 'the light of the file itself', EXT_mesh_gpu_instancing: 'all instances but one',
};

/// json: the file's. Sentences without its name.
export function undrawn(json: {extensionsUsed?: string[]; animations?: unknown[]}): string[] {
    const names = (json.extensionsUsed ?? []).map(name => layers[name]).filter(name => name !== undefined), sentences = [];
    if (names.length > 0) sentences.push(`${names.join(', ')} ${names.length > 1 ? 'are' : 'is'} not drawn.`);
    if (json.animations?.length) sentences.push('its animation stands still.');
    return sentences;
}
