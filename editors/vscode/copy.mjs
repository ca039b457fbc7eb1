// Copies files of the project into the package: the schema of the configuration, and the license.
import { copyFileSync, mkdirSync } from "node:fs";

mkdirSync("schemas", { recursive: true });
copyFileSync("../../robosc/schemas/controller-config.schema.json", "schemas/controller-config.schema.json");
copyFileSync("../../LICENSE", "LICENSE");
