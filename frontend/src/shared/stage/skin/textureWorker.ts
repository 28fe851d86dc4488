/**
 * The worker for KTX2 textures: like `codeWorker`, but its policy allows code made from text, without
 * which the transcoder of these textures cannot start.
 */
import "./codeWorker";
