//! The scene as light sees it: media, lights, cameras, textures, materials.
