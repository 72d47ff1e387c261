// The pages that teach, in the order of the lectures.

export interface LessonEntry {
    /// Its folder.
    name: string;
    title: string;
    about: string;
}

export const lessons: readonly LessonEntry[] = [
    {name: 'projections', title: 'Environment maps and projections', about: 'One direction in five maps at once: lat-long, cube, sphere map, dual paraboloid, octahedral.'},
    {name: 'irradiance', title: 'Irradiance and its Riemann sum', about: 'The cosine integral as a sum of K steps around the normal and J steps down from it, and how far that is from the exact value.'},
    {name: 'phong', title: 'Modified Phong and its levels', about: 'A lobe over the map, the map filtered by it, and what is lost between two levels.'},
    {name: 'split-sum', title: 'The split sum', about: 'The BRDF table by samples, and where n = v = r fails: at grazing angles, beside Monte Carlo.'},
    {name: 'importance', title: 'Importance sampling of an environment', about: 'A random point finds a row, then a column: both cumulative functions, and the loops of a shader.'},
    {name: 'mis', title: 'BRDF, environment, or both', about: 'Three ways to choose directions, the noise of each by roughness, and multiple importance sampling.'},
    {name: 'probes', title: 'Probes: the light at many points', about: 'The light of a point from the eight probes around it: each factor of the weights, the leak through a wall, and parallax.'},
];

/// Of the page that lists them.
export const listTitle = {title: 'Light from every direction', about: 'Image-based lighting in short interactive pages, each computed live from an environment that you may bring.'};
