// The pages that teach, in the order of the lectures.

export interface LessonEntry {
    /// Its folder.
    name: string;
    title: string;
    about: string;
}

export const lessons: readonly LessonEntry[] = [
    {name: 'irradiance', title: 'Irradiance and its Riemann sum', about: 'The cosine integral as a sum of K steps around the normal and J steps down from it, and how far that is from the exact value.'},
];
